#include "infer/mission/mission_machine.hpp"

#include <algorithm>
#include <functional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

using ::testing::HasSubstr;
using S = MissionState;

/// A vehicle that does at once what it is told, over ground that is as the test says.
class Flight : public ::testing::Test {
 protected:
  using Ground = std::function<SiteVerdict(const Eigen::Vector3d& p_world)>;

  void start() {
    machine_.set_manual(false);
    run_for(0.1);
  }

  /// Flies on; a frame every tenth of a second.
  MissionCommand run_for(double duration_s) {
    MissionCommand command;
    const std::int64_t end_ns = now_ns_ + to_nanoseconds(duration_s);
    while (now_ns_ < end_ns) {
      now_ns_ += to_nanoseconds(0.1);
      machine_.set_position(now_ns_, p_world_);
      machine_.set_contact(p_world_.z() <= ground_z_m_ + 0.01);
      if (frames_) machine_.add(now_ns_, frame());
      command = machine_.step(now_ns_);
      p_world_ += 0.1 * command.velocity_mps;
      p_world_.z() = std::max(p_world_.z(), ground_z_m_);
      fastest_mps_ = std::max(fastest_mps_, command.velocity_mps.norm());
    }
    return command;
  }

  MissionCommand run_until(S state, double limit_s = 200) {
    MissionCommand command;
    const std::int64_t limit_ns = now_ns_ + to_nanoseconds(limit_s);
    do command = run_for(0.1);
    while (command.state != state && now_ns_ < limit_ns);
    EXPECT_STREQ(name(command.state), name(state)) << command.reason;
    return command;
  }

  FrameEvidence frame() const {
    FrameEvidence evidence;
    evidence.age_s = age_s_;
    evidence.dense_lidar = dense_;
    if (site_) evidence.accepted = Place{*site_, 3.0};
    evidence.largest = largest_;
    if (const auto rule = machine_.check_rule()) {
      SiteCheck check;
      check.p_world = machine_.target()->place.p_world;
      check.verdict = ground_(check.p_world);
      check.radius_m = check.verdict == SiteVerdict::kSafe ? 3.0 : 0.0;
      evidence.check = check;
    }
    return evidence;
  }

  /// The states in order, as names.
  std::string history() const {
    std::string text = "manual";
    for (const auto& event : machine_.events()) text += " > " + std::string(name(event.to));
    return text;
  }

  MissionConfig config_;
  MissionMachine machine_{config_};
  std::int64_t now_ns_ = to_nanoseconds(1000);
  Eigen::Vector3d p_world_{0, 0, 0};  // starts at the origin of the world, 25 m above ground
  double ground_z_m_ = -25;
  std::optional<Eigen::Vector3d> site_;
  std::optional<Place> largest_;
  bool dense_ = true;
  bool frames_ = true;
  double age_s_ = 0.1;
  double fastest_mps_ = 0;
  Ground ground_ = [](const Eigen::Vector3d&) { return SiteVerdict::kSafe; };
};

TEST_F(Flight, LandsOnASiteThatStaysSafe) {
  site_ = Eigen::Vector3d(8, -5, ground_z_m_);
  start();
  const MissionCommand landed = run_until(S::kTouchdown);
  EXPECT_TRUE(landed.motors_off);
  EXPECT_FALSE(landed.fly);
  EXPECT_EQ(history(), "manual > select > fly above > descend > confirm > final descent > touchdown");
  EXPECT_NEAR((p_world_ - *site_).head<2>().norm(), 0, config_.above_tolerance_m);
  EXPECT_LE(fastest_mps_, config_.fly_speed_mps + 1e-9);
}

TEST_F(Flight, NothingIsCommandedInManualMode) {
  site_ = Eigen::Vector3d(8, -5, ground_z_m_);
  const MissionCommand command = run_for(20);
  EXPECT_EQ(command.state, S::kManual);
  EXPECT_FALSE(command.fly);
  EXPECT_EQ(command.velocity_mps, Eigen::Vector3d::Zero());
}

TEST_F(Flight, APersonTakesOverInTheFinalDescentAndGivesBack) {
  site_ = Eigen::Vector3d(3, 0, ground_z_m_);
  start();
  run_until(S::kFinalDescent);
  machine_.set_manual(true);
  EXPECT_FALSE(run_for(0.1).fly);
  machine_.set_manual(false);
  EXPECT_EQ(run_for(0.1).state, S::kSelect);
}

TEST_F(Flight, WandersAfterFiveSecondsWithoutASite) {
  start();
  EXPECT_EQ(run_for(4.8).state, S::kSelect);
  EXPECT_EQ(run_for(0.4).state, S::kWander);
  const double begun_m = p_world_.head<2>().norm();
  run_for(60);
  EXPECT_GT(p_world_.head<2>().norm(), begun_m + 10);
  EXPECT_LE(p_world_.head<2>().norm(), config_.geofence_radius_m);
}

TEST_F(Flight, NeverLeavesTheFence) {
  start();
  for (int i = 0; i < 2500; ++i) {
    run_for(0.1);
    ASSERT_LE(p_world_.head<2>().norm(), config_.geofence_radius_m + 0.5);
  }
}

TEST_F(Flight, IgnoresSitesOutsideTheFenceAndStaleResults) {
  site_ = Eigen::Vector3d(config_.geofence_radius_m + 1, 0, ground_z_m_);
  start();
  EXPECT_EQ(run_for(6).state, S::kWander);
  site_ = Eigen::Vector3d(5, 0, ground_z_m_);
  age_s_ = config_.max_evidence_age_s + 0.1;
  EXPECT_EQ(run_for(6).state, S::kWander);
  age_s_ = 0.1;
  EXPECT_EQ(run_for(0.1).state, S::kFlyAbove);
}

TEST_F(Flight, TheNetworksDepthConfirmsNothing) {
  site_ = Eigen::Vector3d(3, 0, ground_z_m_);
  dense_ = false;
  start();
  run_until(S::kConfirm);
  const MissionCommand after = run_until(S::kClimbAway);
  EXPECT_THAT(after.reason, HasSubstr("did not confirm"));
  EXPECT_GT(p_world_.z(), ground_z_m_ + config_.confirm_height_m - 1);
}

TEST_F(Flight, FiveDenseFramesInARowConfirm) {
  site_ = Eigen::Vector3d(0.1, 0, ground_z_m_);
  start();
  int frames = 0;
  ground_ = [&](const Eigen::Vector3d&) {
    // One unseen frame in between begins the count anew.
    if (machine_.state() == S::kConfirm) ++frames;
    return frames == 4 ? SiteVerdict::kUnseen : SiteVerdict::kSafe;
  };
  run_until(S::kFinalDescent);
  EXPECT_EQ(frames, 4 + config_.confirm_frames);
}

TEST_F(Flight, ACarOnAConfirmedSiteSendsItUpAndElsewhere) {
  site_ = Eigen::Vector3d(3, 0, ground_z_m_);
  start();
  run_until(S::kFinalDescent);
  run_for(3);
  ground_ = [](const Eigen::Vector3d& p) { return p.x() < 10 ? SiteVerdict::kUnsafe : SiteVerdict::kSafe; };
  const double low_m = p_world_.z();
  const MissionCommand up = run_until(S::kClimbAway, 1.0);
  EXPECT_THAT(up.reason, HasSubstr("turned unsafe"));
  run_for(2);
  EXPECT_GT(p_world_.z(), low_m + 2);
  run_until(S::kSelect);
  run_for(3);
  EXPECT_EQ(machine_.state(), S::kSelect) << "the site that was given up is not chosen again";
  site_ = Eigen::Vector3d(15, 0, ground_z_m_);
  run_until(S::kTouchdown);
  EXPECT_NEAR(p_world_.x(), 15, 0.5);
}

TEST_F(Flight, ASiteOutOfSightIsLost) {
  site_ = Eigen::Vector3d(3, 0, ground_z_m_);
  start();
  run_until(S::kDescend);
  ground_ = [](const Eigen::Vector3d&) { return SiteVerdict::kUnseen; };
  EXPECT_THAT(run_until(S::kClimbAway, config_.site_timeout_s + 0.5).reason, HasSubstr("lost"));
}

TEST_F(Flight, SilenceIsLikeASiteOutOfSight) {
  site_ = Eigen::Vector3d(3, 0, ground_z_m_);
  start();
  run_until(S::kDescend);
  frames_ = false;
  run_until(S::kClimbAway, config_.site_timeout_s + 0.5);
}

TEST_F(Flight, NearTheGroundSightMayEndButDangerAborts) {
  site_ = Eigen::Vector3d(3, 0, ground_z_m_);
  start();
  run_until(S::kFinalDescent);
  while (p_world_.z() > ground_z_m_ + config_.commit_height_m - 0.2) run_for(0.1);
  ground_ = [](const Eigen::Vector3d&) { return SiteVerdict::kUnseen; };
  EXPECT_EQ(run_for(2).state, S::kFinalDescent);
  ground_ = [](const Eigen::Vector3d&) { return SiteVerdict::kUnsafe; };
  run_until(S::kClimbAway, 1.0);
}

TEST_F(Flight, FailedSensorsHoldThenGoOnOrGiveUp) {
  start();
  HealthReport failed;
  failed.state = HealthState::kFailed;
  failed.findings.push_back({"position", "lost", "", 0});
  machine_.set_health(failed);
  const MissionCommand hold = run_for(0.1);
  EXPECT_EQ(hold.state, S::kHold);
  EXPECT_THAT(hold.reason, HasSubstr("position lost"));
  EXPECT_EQ(hold.velocity_mps, Eigen::Vector3d::Zero());
  machine_.set_health({});
  EXPECT_EQ(run_for(0.1).state, S::kSelect);
  machine_.set_health(failed);
  const MissionCommand given_up = run_for(config_.hold_timeout_s + 0.5);
  EXPECT_EQ(given_up.state, S::kGivenUp);
  EXPECT_THAT(given_up.reason, HasSubstr("position lost"));
  machine_.set_health({});
  EXPECT_EQ(run_for(5).state, S::kGivenUp) << "a person has to take over";
}

TEST_F(Flight, FailedSensorsInADescentSendItUp) {
  site_ = Eigen::Vector3d(3, 0, ground_z_m_);
  start();
  run_until(S::kConfirm);
  HealthReport failed;
  failed.state = HealthState::kFailed;
  machine_.set_health(failed);
  EXPECT_EQ(run_for(0.1).state, S::kClimbAway);
  run_until(S::kHold);
}

TEST_F(Flight, WithoutPositionItClimbsNoFartherThanTheWayUp) {
  site_ = Eigen::Vector3d(3, 0, ground_z_m_);
  start();
  run_until(S::kConfirm);
  HealthReport failed;
  failed.state = HealthState::kFailed;
  machine_.set_health(failed);
  double climbed_m = 0;
  for (int i = 0; i < 400; ++i) {
    now_ns_ += to_nanoseconds(0.1);
    climbed_m += 0.1 * machine_.step(now_ns_).velocity_mps.z();  // set_position is not called any more
  }
  EXPECT_GT(climbed_m, -p_world_.z() - 1);
  EXPECT_LT(climbed_m, -p_world_.z() + 4);
}

TEST_F(Flight, LowEnergyTakesTheLeastBadSiteAndSaysSo) {
  start();
  largest_ = Place{{12, 4, ground_z_m_}, 1.4};
  run_until(S::kWander);
  run_for(1);
  largest_ = Place{{-12, 4, ground_z_m_}, 1.0};  // less than least_bad_radius_m
  run_for(20);
  EXPECT_EQ(machine_.state(), S::kWander);
  machine_.set_battery(0.29);
  const MissionCommand command = run_for(0.1);
  EXPECT_EQ(command.state, S::kFlyAbove);
  EXPECT_THAT(command.reason, HasSubstr("ENERGY LOW"));
  EXPECT_THAT(command.reason, HasSubstr("29 %"));
  ASSERT_TRUE(command.target);
  EXPECT_TRUE(command.target->least_bad);
  EXPECT_DOUBLE_EQ(machine_.check_rule()->radius_m, config_.least_bad_radius_m);
  run_until(S::kTouchdown);
  EXPECT_NEAR(p_world_.x(), 12, 0.5);
}

TEST_F(Flight, WithoutEnergyAndSiteItGivesUpLoudly) {
  start();
  const MissionCommand command = run_until(S::kGivenUp, config_.time_critical_s + 1);
  EXPECT_THAT(command.reason, HasSubstr("energy critical"));
  EXPECT_NEAR(p_world_.z(), 0, 1);
}

/// A roof 10 m below fills the view; from 20 m over it its edges are seen, and the street beside it.
TEST_F(Flight, FromNearOverARoofItGoesUpBeforeItChooses) {
  const Eigen::Vector3d roof(0.5, 0, -10);
  const Eigen::Vector3d street(12, 0, ground_z_m_);
  const auto look = [&] { site_ = p_world_.z() < roof.z() + 20 ? roof : street; };
  look();
  start();
  MissionCommand command = run_for(0.2);
  EXPECT_EQ(command.state, S::kClimbAway);
  EXPECT_THAT(command.reason, HasSubstr("too near"));
  EXPECT_THAT(command.reason, HasSubstr("10.0 m"));
  for (int i = 0; i < 2000 && command.state != S::kTouchdown; ++i) {
    look();
    command = run_for(0.1);
    if (command.target) ASSERT_EQ(command.target->chosen_p_world, street);
  }
  EXPECT_EQ(
      history(),
      "manual > select > climb away > select > fly above > descend > confirm > final descent > touchdown");
}

TEST_F(Flight, WhatStaysNearBelowDoesNotLeadItUpForEver) {
  config_.time_low_s = 1000;
  config_.time_critical_s = 1000;
  machine_ = MissionMachine(config_);
  const auto look = [&] { site_ = p_world_ - Eigen::Vector3d(0, 0, 9); };
  look();
  start();
  double highest_m = 0;
  for (int i = 0; i < 1500; ++i) {
    look();
    const MissionCommand command = run_for(0.1);
    ASSERT_STRNE(name(command.state), name(S::kFlyAbove));
    highest_m = std::max(highest_m, p_world_.z());
  }
  EXPECT_GT(highest_m, config_.choose_height_m - 2);
  EXPECT_LT(highest_m, config_.choose_height_m + 1);
  int climbs = 0;
  for (const auto& event : machine_.events()) climbs += event.to == S::kClimbAway ? 1 : 0;
  EXPECT_LE(climbs, 3);
}

TEST_F(Flight, GivenBackLowItGoesUpBeforeItChooses) {
  site_ = Eigen::Vector3d(3, 0, ground_z_m_);
  start();
  run_until(S::kConfirm);
  p_world_.z() = ground_z_m_ + 15;
  machine_.set_manual(true);
  run_for(0.1);
  machine_.set_manual(false);
  EXPECT_EQ(run_for(0.2).state, S::kClimbAway);
  run_until(S::kFlyAbove);
  EXPECT_GE(p_world_.z() - ground_z_m_, config_.choose_height_m - 0.5);
}

TEST_F(Flight, WithoutAHeightToChooseFromItChoosesFromAnywhere) {
  config_.choose_height_m = 0;
  machine_ = MissionMachine(config_);
  p_world_.z() = ground_z_m_ + 12;
  site_ = Eigen::Vector3d(3, 0, ground_z_m_);
  start();
  run_until(S::kTouchdown);
  EXPECT_EQ(history(), "manual > select > fly above > descend > confirm > final descent > touchdown");
}

TEST_F(Flight, AnAbortClimbsFromTheFinalDescentAndSearchesOn) {
  site_ = Eigen::Vector3d(3, 0, ground_z_m_);
  start();
  run_until(S::kFinalDescent);
  machine_.abort();
  EXPECT_EQ(run_for(0.1).state, S::kClimbAway);
  run_until(S::kSelect);
}

TEST_F(Flight, TheSameInputsGiveTheSameCommands) {
  site_ = Eigen::Vector3d(8, -5, ground_z_m_);
  MissionMachine other(config_);
  machine_.set_manual(false);
  other.set_manual(false);
  for (int i = 0; i < 400; ++i) {
    const std::int64_t t_ns = now_ns_ + to_nanoseconds(0.1 * i);
    Eigen::Vector3d velocity[2];
    int k = 0;
    for (MissionMachine* machine : {&machine_, &other}) {
      machine->set_position(t_ns, p_world_);
      machine->add(t_ns, frame());
      velocity[k++] = machine->step(t_ns).velocity_mps;
    }
    ASSERT_EQ(velocity[0], velocity[1]);
    p_world_ += 0.1 * velocity[0];
  }
}

}  // namespace
}  // namespace alight
