#pragma once

#include <array>

namespace alight {

/// What a landing is doing (paper 3.3; METHOD, "Landing site"). The paper's numbers are 1, 7 and 8.
enum class MissionState {
  kManual,        ///< a person flies; nothing is commanded
  kSelect,        ///< 1: hovers and looks for a site
  kFlyAbove,      ///< 2: flies over the site at search height
  kDescend,       ///< 3: descends over the site while it stays safe
  kWander,        ///< 7: searches elsewhere on a path that does not repeat
  kConfirm,       ///< 8: hovers low, looks again with dense LiDAR alone
  kFinalDescent,  ///< comes down to the ground
  kTouchdown,     ///< has landed
  kClimbAway,     ///< straight up, back to search height
  kHold,          ///< sensors have failed: stands still and waits
  kGivenUp,       ///< hovers at search height until a person takes over
};

constexpr std::array<MissionState, 11> kMissionStates = {
    MissionState::kManual,    MissionState::kSelect,  MissionState::kFlyAbove,     MissionState::kDescend,
    MissionState::kWander,    MissionState::kConfirm, MissionState::kFinalDescent, MissionState::kTouchdown,
    MissionState::kClimbAway, MissionState::kHold,    MissionState::kGivenUp};

/// "select", "fly above", ...
const char* name(MissionState state);

}  // namespace alight
