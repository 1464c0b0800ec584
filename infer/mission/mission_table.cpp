#include "infer/mission/mission_table.hpp"

#include <fmt/format.h>

namespace alight {
namespace {

using S = MissionState;
using G = Guard;

template <class... States>
constexpr StateSet from(States... states) {
  return (bit(states) | ...);
}
template <class... Guards>
constexpr GuardSet when(Guards... guards) {
  return (bit(guards) | ...);
}
constexpr GuardSet kAlways = 0;
constexpr GuardSet kNone = 0;

struct StateText {
  S state;
  const char* number;
  const char* name;
  const char* does;
};

constexpr StateText kTexts[] = {
    {S::kManual, "", "manual", "nothing is commanded"},
    {S::kSelect, "1", "select", "hovers and looks for a site"},
    {S::kFlyAbove, "2", "fly above", "flies over the site at search height"},
    {S::kDescend, "3", "descend", "descends over the site while it stays safe"},
    {S::kWander, "7", "wander", "searches along a spiral inside the geofence"},
    {S::kConfirm, "8", "confirm", "hovers low and looks again with dense LiDAR alone"},
    {S::kFinalDescent, "", "final descent", "comes down, still watching the site"},
    {S::kTouchdown, "", "touchdown", "has landed"},
    {S::kClimbAway, "", "climb away", "straight up, back to search height"},
    {S::kHold, "", "hold", "stands still: sensors have failed"},
    {S::kGivenUp, "", "given up", "hovers at search height until a person takes over"},
};

const char* text(S state, const char* StateText::* member) {
  for (const StateText& row : kTexts) {
    if (row.state == state) return row.*member;
  }
  return "";
}

/// "select, wander"; a set that leaves out few is told by what it leaves out.
std::string names(StateSet states) {
  std::string in;
  std::string out;
  int count = 0;
  for (const S state : kMissionStates) {
    const bool member = (states & bit(state)) != 0;
    std::string& list = member ? in : out;
    list += (list.empty() ? "" : ", ") + std::string(name(state));
    count += member ? 1 : 0;
  }
  return count > 6 ? "all but " + out : in;
}

std::string guards_text(const Transition& row) {
  std::string text;
  for (int i = 0; i < kGuards; ++i) {
    const G guard = static_cast<G>(i);
    if ((row.when & bit(guard)) != 0) text += (text.empty() ? "" : " and ") + std::string(name(guard));
  }
  for (int i = 0; i < kGuards; ++i) {
    const G guard = static_cast<G>(i);
    if ((row.unless & bit(guard)) != 0) text += (text.empty() ? "not " : ", not ") + std::string(name(guard));
  }
  return text;
}

}  // namespace

const char* name(MissionState state) { return text(state, &StateText::name); }

const char* name(Guard guard) {
  switch (guard) {
    case G::kManual:
      return "manual mode";
    case G::kAbort:
      return "abort commanded";
    case G::kHealthFailed:
      return "sensors failed";
    case G::kContact:
      return "ground contact";
    case G::kSiteAccepted:
      return "site accepted";
    case G::kSearchTooLow:
      return "search too low";
    case G::kTargetUnsafe:
      return "site unsafe";
    case G::kTargetLost:
      return "site lost";
    case G::kAboveTarget:
      return "above the site";
    case G::kAtConfirmHeight:
      return "at the height of confirmation";
    case G::kConfirmedDense:
      return "confirmed by dense LiDAR";
    case G::kCommitted:
      return "committed";
    case G::kAtSearchHeight:
      return "at search height";
    case G::kEnergyLow:
      return "energy low";
    case G::kEnergyCritical:
      return "energy critical";
    case G::kLeastBadKnown:
      return "least bad site known";
    case G::kTimeout:
      return "time-out";
  }
  return "";
}

const std::vector<Transition>& mission_transitions() {
  constexpr StateSet kAirborne = from(S::kSelect, S::kFlyAbove, S::kDescend, S::kWander, S::kConfirm,
                                      S::kFinalDescent, S::kHold, S::kGivenUp);
  constexpr StateSet kAutomatic = kAirborne | from(S::kClimbAway, S::kTouchdown);
  constexpr StateSet kSearching = from(S::kSelect, S::kWander);
  static const std::vector<Transition> kTable = {
      // A person comes first, then an abort.
      {kAutomatic, when(G::kManual), kNone, S::kManual, "a person flies"},
      {from(S::kManual), kAlways, when(G::kManual), S::kSelect, "automatic mode"},
      {kAirborne, when(G::kAbort), kNone, S::kClimbAway, "an abort was commanded"},
      // Ground under the skids, wanted or not.
      {from(S::kFinalDescent), when(G::kContact), kNone, S::kTouchdown, "on the ground at a confirmed site"},
      {from(S::kDescend, S::kConfirm), when(G::kContact), kNone, S::kClimbAway, "unexpected contact"},
      // Sensors that have failed.
      {from(S::kSelect, S::kWander, S::kFlyAbove), when(G::kHealthFailed), kNone, S::kHold, "sensors failed"},
      {from(S::kDescend, S::kConfirm), when(G::kHealthFailed), kNone, S::kClimbAway, "sensors failed"},
      {from(S::kFinalDescent), when(G::kHealthFailed), when(G::kCommitted), S::kClimbAway, "sensors failed"},
      {from(S::kHold), when(G::kEnergyCritical), kNone, S::kGivenUp, "energy critical while sensors failed"},
      {from(S::kHold), kAlways, when(G::kHealthFailed), S::kSelect, "sensors are back"},
      {from(S::kHold), when(G::kTimeout), kNone, S::kGivenUp, "sensors stay failed"},
      // Searching.
      {kSearching, when(G::kEnergyCritical), kNone, S::kGivenUp, "energy critical and no site to go to"},
      {kSearching, when(G::kSearchTooLow), kNone, S::kClimbAway,
       "too near to the ground to see what surrounds a site"},
      {kSearching, when(G::kSiteAccepted), kNone, S::kFlyAbove, "a site counts"},
      {kSearching, when(G::kEnergyLow, G::kLeastBadKnown), kNone, S::kFlyAbove,
       "ENERGY LOW: least bad site instead of a good one"},
      {from(S::kSelect), when(G::kTimeout), kNone, S::kWander, "no site counts here"},
      // 2: above the site
      {from(S::kFlyAbove), when(G::kTargetUnsafe), kNone, S::kSelect, "the site turned unsafe"},
      {from(S::kFlyAbove), when(G::kTargetLost), kNone, S::kSelect, "the site was lost"},
      {from(S::kFlyAbove), when(G::kAboveTarget), kNone, S::kDescend, "above the site"},
      {from(S::kFlyAbove), when(G::kTimeout), kNone, S::kSelect, "the site was not reached"},
      // 3: down, tracking it
      {from(S::kDescend), when(G::kTargetUnsafe), kNone, S::kClimbAway, "the site turned unsafe"},
      {from(S::kDescend), when(G::kTargetLost), kNone, S::kClimbAway, "the site was lost"},
      {from(S::kDescend), when(G::kAtConfirmHeight), kNone, S::kConfirm, "low enough to confirm"},
      {from(S::kDescend), when(G::kTimeout), kNone, S::kClimbAway, "the descent took too long"},
      // 8: dense LiDAR alone
      {from(S::kConfirm), when(G::kTargetUnsafe), kNone, S::kClimbAway, "dense LiDAR sees the site unsafe"},
      {from(S::kConfirm), when(G::kConfirmedDense), kNone, S::kFinalDescent, "confirmed by dense LiDAR"},
      {from(S::kConfirm), when(G::kTimeout), kNone, S::kClimbAway, "dense LiDAR did not confirm the site"},
      {from(S::kFinalDescent), when(G::kTargetUnsafe), kNone, S::kClimbAway,
       "the confirmed site turned unsafe"},
      {from(S::kFinalDescent), when(G::kTargetLost), when(G::kCommitted), S::kClimbAway, "the site was lost"},
      {from(S::kFinalDescent), when(G::kTimeout), kNone, S::kClimbAway, "no ground where it was expected"},
      // Up again.
      {from(S::kClimbAway), when(G::kAtSearchHeight, G::kEnergyCritical), kNone, S::kGivenUp,
       "energy critical"},
      {from(S::kClimbAway), when(G::kAtSearchHeight, G::kHealthFailed), kNone, S::kHold, "sensors failed"},
      {from(S::kClimbAway), when(G::kAtSearchHeight), kNone, S::kSelect, "back at search height"},
      {from(S::kClimbAway), when(G::kTimeout), kNone, S::kHold, "search height was not reached"},
  };
  return kTable;
}

const Transition* next_transition(MissionState state, GuardSet guards) {
  for (const Transition& row : mission_transitions()) {
    const bool applies =
        (row.from & bit(state)) != 0 && (guards & row.when) == row.when && (guards & row.unless) == 0;
    if (applies) return &row;
  }
  return nullptr;
}

const std::vector<StateTimeout>& state_timeouts() {
  using C = MissionConfig;
  static const std::vector<StateTimeout> kTable = {
      {S::kSelect, &C::select_timeout_s, "select_timeout_s"},
      {S::kFlyAbove, &C::fly_above_timeout_s, "fly_above_timeout_s"},
      {S::kDescend, &C::descend_timeout_s, "descend_timeout_s"},
      {S::kConfirm, &C::confirm_timeout_s, "confirm_timeout_s"},
      {S::kFinalDescent, &C::final_timeout_s, "final_timeout_s"},
      {S::kClimbAway, &C::climb_timeout_s, "climb_timeout_s"},
      {S::kHold, &C::hold_timeout_s, "hold_timeout_s"},
  };
  return kTable;
}

std::string mission_tables_markdown() {
  const MissionConfig defaults;
  std::string page = "| state | paper's number | what happens | time-out |\n|---|---|---|---:|\n";
  for (const StateText& row : kTexts) {
    std::string limit;
    for (const StateTimeout& timeout : state_timeouts()) {
      if (timeout.state != row.state) continue;
      limit = fmt::format("`{}` ({:g} s)", timeout.key, defaults.*timeout.limit_s);
    }
    page += "| " + std::string(row.name) + " | " + row.number + " | " + row.does + " | " + limit + " |\n";
  }
  page += "\n| from | when | to | reason |\n|---|---|---|---|\n";
  for (const Transition& row : mission_transitions()) {
    page += "| " + names(row.from) + " | " + guards_text(row) + " | " + name(row.to) + " | " + row.reason +
            " |\n";
  }
  return page;
}

}  // namespace alight
