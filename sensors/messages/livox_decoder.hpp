#pragma once

#include <optional>

#include "sensors/messages/decoders.hpp"

namespace alight {

/// livox_ros_driver/CustomMsg. A point's time is header.stamp + offset_time: the stamp is what clock
/// corrections rewrite, `timebase` stays on the sensor's own clock.
std::optional<DecodedMessage> decode_livox(const RawMessage& message, const DecodeOptions& options);

}  // namespace alight
