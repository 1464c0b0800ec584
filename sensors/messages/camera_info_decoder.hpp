#pragma once

#include <optional>

#include "sensors/messages/decoders.hpp"

namespace alight {

/// sensor_msgs/CameraInfo; empty where the camera is not calibrated (K is zero).
std::optional<DecodedMessage> decode_camera_info(const RawMessage& message, const DecodeOptions& options);

}  // namespace alight
