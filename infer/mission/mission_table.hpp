#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "infer/mission/mission_config.hpp"
#include "infer/mission/mission_state.hpp"

namespace alight {

/// What may be true at a moment of a landing; transitions are drawn from nothing else.
enum class Guard : std::uint8_t {
  kManual,           ///< a person has the vehicle
  kAbort,            ///< an abort was commanded
  kHealthFailed,     ///< HealthState::kFailed
  kContact,          ///< the autopilot feels the ground
  kSiteAccepted,     ///< a site counts: inside the geofence, choose_height_m below, not given up before
  kSearchTooLow,     ///< a site would count but for choose_height_m, and the vehicle may go higher
  kTargetUnsafe,     ///< the chosen site was seen unsafe in unsafe_frames consecutive frames
  kTargetLost,       ///< it was not seen safe for site_timeout_s
  kAboveTarget,      ///< within above_tolerance_m of it
  kAtConfirmHeight,  ///< down to confirm_height_m over it
  kConfirmedDense,   ///< confirm_frames consecutive frames of dense LiDAR alone found it safe
  kCommitted,        ///< below commit_height_m over it
  kAtSearchHeight,
  kEnergyLow,       ///< battery_low or time_low_s is reached
  kEnergyCritical,  ///< battery_critical or time_critical_s is reached
  kLeastBadKnown,   ///< a place of least_bad_radius_m was seen
  kTimeout,         ///< the state's time-out has passed since it was entered
};
constexpr int kGuards = 17;
const char* name(Guard guard);

/// Guards as bits.
using GuardSet = std::uint32_t;
constexpr GuardSet bit(Guard guard) { return GuardSet{1} << static_cast<unsigned>(guard); }

/// States as bits.
using StateSet = std::uint32_t;
constexpr StateSet bit(MissionState state) { return StateSet{1} << static_cast<unsigned>(state); }

/// One row: from any of `from`, when all of `when` and none of `unless` hold.
struct Transition {
  StateSet from;
  GuardSet when;
  GuardSet unless;
  MissionState to;
  const char* reason;
};

/// Every transition there is; of those that apply, the first is taken.
const std::vector<Transition>& mission_transitions();
/// The row that applies; null: the state stays.
const Transition* next_transition(MissionState state, GuardSet guards);

/// One state's time-out; null: it has none.
struct StateTimeout {
  MissionState state;
  double MissionConfig::* limit_s;
  const char* key;
};
const std::vector<StateTimeout>& state_timeouts();

/// Both tables as Markdown: docs/mission.md holds this text, and a test compares.
std::string mission_tables_markdown();

}  // namespace alight
