#include "infer/mission/mission_table.hpp"

#include <fstream>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "infer/mission/mission_config.hpp"
#include "tests/support/file_text.hpp"

namespace alight {
namespace {

constexpr GuardSet kAll = (GuardSet{1} << kGuards) - 1;

/// Every transition that any combination of guards can cause: the machine's whole behaviour, since it takes transitions
/// from the table alone.
std::set<std::pair<MissionState, MissionState>> possible_steps(MissionState without = MissionState::kManual,
                                                               bool leave_out = false) {
  std::set<std::pair<MissionState, MissionState>> steps;
  for (const MissionState state : kMissionStates) {
    for (GuardSet guards = 0; guards <= kAll; ++guards) {
      const Transition* row = next_transition(state, guards);
      if (row == nullptr || (leave_out && row->to == without)) continue;
      steps.insert({state, row->to});
    }
  }
  return steps;
}

std::set<MissionState> reachable(MissionState start,
                                 const std::set<std::pair<MissionState, MissionState>>& steps) {
  std::set<MissionState> seen{start};
  for (bool grew = true; grew;) {
    grew = false;
    for (const auto& [from, to] : steps) {
      if (seen.count(from) != 0) grew = seen.insert(to).second || grew;
    }
  }
  return seen;
}

TEST(MissionTable, TouchdownIsReachableOnlyThroughConfirm) {
  EXPECT_EQ(reachable(MissionState::kManual, possible_steps()).count(MissionState::kTouchdown), 1u);
  const auto steps = possible_steps(MissionState::kConfirm, true);
  for (const MissionState start : kMissionStates) {
    if (start == MissionState::kConfirm || start == MissionState::kFinalDescent ||
        start == MissionState::kTouchdown) {
      continue;
    }
    EXPECT_EQ(reachable(start, steps).count(MissionState::kTouchdown), 0u) << name(start);
  }
  for (const auto& [from, to] : possible_steps()) {
    if (to == MissionState::kTouchdown) EXPECT_EQ(from, MissionState::kFinalDescent);
    if (to == MissionState::kFinalDescent) EXPECT_EQ(from, MissionState::kConfirm);
  }
}

TEST(MissionTable, TheFinalDescentNeedsDenseLidarTheTouchdownContact) {
  for (GuardSet guards = 0; guards <= kAll; ++guards) {
    const Transition* row = next_transition(MissionState::kConfirm, guards);
    if (row != nullptr && row->to == MissionState::kFinalDescent) {
      ASSERT_NE(guards & bit(Guard::kConfirmedDense), 0u);
      ASSERT_EQ(guards & (bit(Guard::kTargetUnsafe) | bit(Guard::kHealthFailed)), 0u);
    }
    row = next_transition(MissionState::kFinalDescent, guards);
    if (row != nullptr && row->to == MissionState::kTouchdown) ASSERT_NE(guards & bit(Guard::kContact), 0u);
  }
}

TEST(MissionTable, APersonTakesOverFromEveryStateWhateverElseHolds) {
  for (const MissionState state : kMissionStates) {
    for (GuardSet guards = 0; guards <= kAll; ++guards) {
      if ((guards & bit(Guard::kManual)) == 0) continue;
      const Transition* row = next_transition(state, guards);
      const MissionState after = row != nullptr ? row->to : state;
      ASSERT_EQ(after, MissionState::kManual) << name(state) << " with guards " << guards;
    }
  }
}

TEST(MissionTable, AnAbortLeadsUpFromEveryAirborneStateWhateverElseHolds) {
  for (const MissionState state : kMissionStates) {
    if (state == MissionState::kManual || state == MissionState::kTouchdown ||
        state == MissionState::kClimbAway)
      continue;
    for (GuardSet guards = 0; guards <= kAll; ++guards) {
      if ((guards & bit(Guard::kManual)) != 0 || (guards & bit(Guard::kAbort)) == 0) continue;
      const Transition* row = next_transition(state, guards);
      ASSERT_NE(row, nullptr);
      ASSERT_EQ(row->to, MissionState::kClimbAway) << name(state) << " with guards " << guards;
    }
  }
}

TEST(MissionTable, AnUnsafeSiteIsNeverDescendedTo) {
  for (const MissionState state :
       {MissionState::kDescend, MissionState::kConfirm, MissionState::kFinalDescent}) {
    for (GuardSet guards = 0; guards <= kAll; ++guards) {
      const bool others = (guards & (bit(Guard::kManual) | bit(Guard::kContact))) != 0;
      if (others || (guards & bit(Guard::kTargetUnsafe)) == 0) continue;
      const Transition* row = next_transition(state, guards);
      ASSERT_NE(row, nullptr);
      ASSERT_EQ(row->to, MissionState::kClimbAway) << name(state) << " with guards " << guards;
    }
  }
}

TEST(MissionTable, NoStateIsDead) {
  const auto steps = possible_steps();
  const auto from_start = reachable(MissionState::kManual, steps);
  for (const MissionState state : kMissionStates) {
    EXPECT_EQ(from_start.count(state), 1u) << name(state) << " is never entered";
    EXPECT_EQ(reachable(state, steps).size(), kMissionStates.size())
        << name(state) << " does not lead everywhere";
  }
}

/// Where nothing happens but time, every automatic state that descends, holds or waits for something is left.
TEST(MissionTable, TimeAloneEndsEveryStateThatWaits) {
  for (const MissionState state : kMissionStates) {
    const bool final_state = state == MissionState::kManual || state == MissionState::kTouchdown ||
                             state == MissionState::kGivenUp;
    if (final_state) continue;
    const GuardSet late = bit(Guard::kTimeout) | bit(Guard::kEnergyLow) | bit(Guard::kEnergyCritical);
    EXPECT_NE(next_transition(state, late), nullptr) << name(state);
    EXPECT_NE(next_transition(state, late | bit(Guard::kHealthFailed)), nullptr) << name(state);
  }
}

TEST(MissionTable, EveryRowCanBeTaken) {
  for (const Transition& row : mission_transitions()) {
    bool taken = false;
    for (const MissionState state : kMissionStates) {
      for (GuardSet guards = 0; guards <= kAll && !taken; ++guards)
        taken = next_transition(state, guards) == &row;
    }
    EXPECT_TRUE(taken) << "to " << name(row.to) << ": " << row.reason;
  }
}

TEST(MissionTable, NoRowLeadsToItsOwnState) {
  for (const auto& [from, to] : possible_steps()) EXPECT_NE(from, to) << name(from);
}

TEST(MissionTable, TheDocumentationHoldsTheTable) {
  const std::string page = test::file_text(ALIGHT_SOURCE_DIR "/docs/mission.md");
  EXPECT_NE(page.find(mission_tables_markdown()), std::string::npos)
      << "docs/mission.md is out of date; put the output of alight-sim land --print-states in its place:\n"
      << mission_tables_markdown();
}

}  // namespace
}  // namespace alight
