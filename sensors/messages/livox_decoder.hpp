#pragma once

#include <optional>

#include "sensors/messages/decoders.hpp"

namespace alight {

/// livox_ros_driver/CustomMsg. A point's time is header.stamp + offset_time: the stamp is what clock
/// corrections rewrite, `timebase` stays on the sensor's own clock.
std::optional<DecodedMessage> decode_livox(const RawMessage& message, const DecodeOptions& options);
/// livox_ros_driver2/CustomMsg: the same bytes, but another table of noise marks (is_noise_of_livox2).
std::optional<DecodedMessage> decode_livox2(const RawMessage& message, const DecodeOptions& options);

/// Whether the tag of a Mid-40, Mid-70, Horizon, Tele or Avia marks a point as noise. Bits 0-1 judge its place between other
/// points, bits 2-3 its intensity (rain, fog, dust): 1 high, 2 moderate confidence that it is noise, 3 low (of the place).
/// Source: the table of Autoware's livox_tag_filter, after Livox's manuals of these sensors.
bool is_noise_of_livox(std::uint8_t tag, NoisePoints noise);
/// The same of a Mid-360 or HAP, whose driver is livox_ros_driver2. Bits 0-1, 2-3 and 4-5 judge the point by its neighbours,
/// by rain and dust, and by other signs, as confidence in the point: 0 high, 1 moderate, 2 low.
bool is_noise_of_livox2(std::uint8_t tag, NoisePoints noise);

}  // namespace alight
