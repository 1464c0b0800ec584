#include "sensors/messages/vehicle_decoders.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "sensors/messages/pose_reading.hpp"

namespace alight {
std::optional<DecodedMessage> decode_quaternion(const RawMessage& message, const DecodeOptions& options) {
  ByteReader reader(message);
  AttitudeSample out;
  out.t_ns = read_stamp(reader, message, options);
  out.q_world_imu = unit_quaternion(read_quaternion(reader));
  reader.expect_end();
  return out;
}

std::optional<DecodedMessage> decode_imu_attitude(const RawMessage& message, const DecodeOptions& options) {
  ByteReader reader(message);
  AttitudeSample out;
  out.t_ns = read_stamp(reader, message, options);
  const Eigen::Quaterniond orientation = read_quaternion(reader);
  const auto covariance = reader.read<double>();
  reader.take(8 * sizeof(double));
  const double rate_rad_s = read_vector(reader).norm();
  const auto rate_covariance = reader.read<double>();
  reader.take(8 * sizeof(double));
  reader.take(12 * sizeof(double));  // acceleration and its covariance
  reader.expect_end();
  if (rate_covariance != -1 && std::isfinite(rate_rad_s)) out.rate_rad_s = rate_rad_s;
  if (covariance == -1) return std::nullopt;
  out.q_world_imu = unit_quaternion(orientation);
  return out;
}

std::optional<DecodedMessage> decode_fix(const RawMessage& message, const DecodeOptions& options) {
  ByteReader reader(message);
  PositionSample out;
  out.t_ns = read_stamp(reader, message, options);
  const auto status = reader.read<std::int8_t>();
  reader.read<std::uint16_t>();  // service: which satellites
  GeodeticPosition fix;
  fix.latitude_deg = reader.read<double>();
  fix.longitude_deg = reader.read<double>();
  fix.altitude_m = reader.read<double>();
  const auto east_m2 = reader.read<double>();
  reader.take(3 * sizeof(double));
  const auto north_m2 = reader.read<double>();
  reader.take(4 * sizeof(double));
  const auto covariance_kind = reader.read<std::uint8_t>();
  reader.expect_end();
  constexpr std::uint8_t kUnknown = 0;
  const double largest_m2 = std::max(east_m2, north_m2);
  if (covariance_kind != kUnknown && largest_m2 > 0) fix.sigma_m = std::sqrt(largest_m2);
  if (status < 0) return std::nullopt;
  const bool on_earth = std::abs(fix.latitude_deg) <= 90 && std::abs(fix.longitude_deg) <= 360 &&
                        std::abs(fix.altitude_m) < 1e5;  // false for NaN
  if (!on_earth) {
    throw DecodeError("fix at latitude " + std::to_string(fix.latitude_deg) + ", longitude " +
                      std::to_string(fix.longitude_deg) + ", altitude " + std::to_string(fix.altitude_m));
  }
  out.position = fix;
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
