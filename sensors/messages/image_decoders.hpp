#pragma once

#include <optional>

#include "sensors/messages/decoders.hpp"

namespace alight {

/// sensor_msgs/Image: mono8, mono16, rgb8, bgr8, rgba8, bgra8, bayer_{rggb,bggr,gbrg,grbg}8, yuv422, yuv422_yuy2.
std::optional<DecodedMessage> decode_image(const RawMessage& message, const DecodeOptions& options);
/// sensor_msgs/CompressedImage: JPEG and PNG.
std::optional<DecodedMessage> decode_compressed_image(const RawMessage& message,
                                                      const DecodeOptions& options);

}  // namespace alight
