#pragma once

#include <cstdint>
#include <vector>

#include "geometry/rig/rig.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// A hover of `duration_s` above level, textured ground at `height_m`, as messages in order of arrival: 20 Hz stereo,
/// 10 Hz LiDAR of 10,000 points, 100 Hz attitude, 50 Hz position. For timing the loop without a log; what it predicts
/// says nothing about a network.
std::vector<LogMessage> synthetic_hover(const Rig& rig, double height_m, double duration_s);

}  // namespace alight
