#pragma once

#include <optional>

#include "sensors/messages/decoders.hpp"

namespace alight {

/// geometry_msgs/QuaternionStamped.
std::optional<DecodedMessage> decode_quaternion(const RawMessage& message, const DecodeOptions& options);
/// sensor_msgs/Imu, its orientation; empty where the message says that it has none (covariance[0] = -1).
std::optional<DecodedMessage> decode_imu_attitude(const RawMessage& message, const DecodeOptions& options);
/// sensor_msgs/NavSatFix; empty where the receiver has no fix.
std::optional<DecodedMessage> decode_fix(const RawMessage& message, const DecodeOptions& options);
/// std_msgs/Float32 as a height; it has no stamp, its time is the receive time.
std::optional<DecodedMessage> decode_float_height(const RawMessage& message, const DecodeOptions& options);

}  // namespace alight
