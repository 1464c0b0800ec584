#pragma once

#include <cmath>
#include <string>

#include "sensors/messages/byte_reader.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// A quaternion of the wire (x y z w), as it is.
inline Eigen::Quaterniond read_quaternion(ByteReader& reader) {
  const auto x = reader.read<double>();
  const auto y = reader.read<double>();
  const auto z = reader.read<double>();
  const auto w = reader.read<double>();
  return {w, x, y, z};
}

/// @throws DecodeError if its length is not 1; autopilots send all zeros until they have an attitude
inline Eigen::Quaterniond unit_quaternion(const Eigen::Quaterniond& q) {
  const double norm = q.norm();
  if (!(std::abs(norm - 1) < 0.01)) throw DecodeError("quaternion of length " + std::to_string(norm));
  return q.normalized();
}

/// geometry_msgs/Point or Vector3.
inline Eigen::Vector3d read_vector(ByteReader& reader) {
  const auto x = reader.read<double>();
  const auto y = reader.read<double>();
  const auto z = reader.read<double>();
  return {x, y, z};
}

}  // namespace alight
