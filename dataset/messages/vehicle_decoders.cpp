#include <cmath>
#include <string>

#include "dataset/messages/decoders.hpp"

namespace alight {
namespace {

/// A quaternion of the wire (x y z w). Autopilots send all zeros until they have an attitude.
Eigen::Quaterniond read_unit_quaternion(ByteReader& reader) {
  const auto x = reader.read<double>();
  const auto y = reader.read<double>();
  const auto z = reader.read<double>();
  const auto w = reader.read<double>();
  const Eigen::Quaterniond q(w, x, y, z);
  const double norm = q.norm();
  if (!(std::abs(norm - 1) < 0.01)) throw DecodeError("quaternion of length " + std::to_string(norm));
  return q.normalized();
}

}  // namespace

std::optional<DecodedMessage> decode_quaternion(const RawMessage& message, const DecodeOptions&) {
  ByteReader reader(message);
  AttitudeSample out;
  out.t_ns = reader.read_header();
  out.q_world_imu = read_unit_quaternion(reader);
  reader.expect_end();
  return out;
}

std::optional<DecodedMessage> decode_imu_attitude(const RawMessage& message, const DecodeOptions&) {
  constexpr std::size_t kQuaternionBytes = 4 * sizeof(double);
  constexpr std::size_t kRatesAndAccelerationBytes = 24 * sizeof(double);
  ByteReader reader(message);
  AttitudeSample out;
  out.t_ns = reader.read_header();
  RawMessage orientation{reader.take(kQuaternionBytes), kQuaternionBytes, message.receive_ns};
  const auto covariance = reader.read<double>();
  reader.take(8 * sizeof(double) + kRatesAndAccelerationBytes);
  reader.expect_end();
  if (covariance == -1) return std::nullopt;
  ByteReader quaternion(orientation);
  out.q_world_imu = read_unit_quaternion(quaternion);
  return out;
}

std::optional<DecodedMessage> decode_fix(const RawMessage& message, const DecodeOptions&) {
  ByteReader reader(message);
  PositionSample out;
  out.t_ns = reader.read_header();
  const auto status = reader.read<std::int8_t>();
  reader.read<std::uint16_t>();  // service: which satellites
  out.latitude_deg = reader.read<double>();
  out.longitude_deg = reader.read<double>();
  out.altitude_m = reader.read<double>();
  reader.take(9 * sizeof(double) + 1);  // covariance and its kind
  reader.expect_end();
  if (status < 0) return std::nullopt;
  const bool on_earth = std::abs(out.latitude_deg) <= 90 && std::abs(out.longitude_deg) <= 360 &&
                        std::abs(out.altitude_m) < 1e5;  // false for NaN
  if (!on_earth) {
    throw DecodeError("fix at latitude " + std::to_string(out.latitude_deg) + ", longitude " +
                      std::to_string(out.longitude_deg) + ", altitude " + std::to_string(out.altitude_m));
  }
  return out;
}

std::optional<DecodedMessage> decode_float_height(const RawMessage& message, const DecodeOptions&) {
  ByteReader reader(message);
  HeightSample out;
  out.t_ns = message.receive_ns;
  out.height_m = static_cast<double>(reader.read<float>());
  reader.expect_end();
  if (!std::isfinite(out.height_m)) throw DecodeError("height is not finite");
  return out;
}

}  // namespace alight
