#include "closed_loop/landing/landing_flight.hpp"

#include <algorithm>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "closed_loop/landing/landing_pictures.hpp"
#include "sensors/stream/flight_log.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight::closed_loop {
namespace {

namespace fs = std::filesystem;

/// A small open place from low above, without a camera: seconds to fly.
LandConfig quick() {
  LandConfig config;
  config.rig = (fs::path(ALIGHT_SOURCE_DIR) / "configs" / "rigs" / "paper.yaml").string();
  config.world.look = sim::Look::kFarmland;
  config.world.seed = 200002;
  config.world.size_m = 70;
  config.flight.images = false;
  config.flight.start_height_m = 15;
  config.flight.clear_above_m = 3;
  config.mission.geofence_radius_m = 10;
  config.mission.choose_height_m = 0;  // there are no roofs
  return config;
}

/// The row without what a computer's speed decides.
std::string row(FlownLanding flown) {
  flown.result.cost_s = 0;
  return to_json(flown.result);
}

class LandingFlightTest : public ::testing::Test {
 protected:
  /// The quick landing, flown once for the tests that ask for it.
  struct Landing {
    Landing() {
      sim::BagWriter bag(log(), sim::BagCompression::kNone);
      flown = flight.fly(&bag);
      bag.commit();
    }
    fs::path log() const { return scratch / "log.bag"; }

    test::ScratchFolder scratch;
    LandingFlight flight{quick(), 200002, nullptr};
    FlownLanding flown;
  };
  static Landing& landing() {
    static Landing quick_landing;
    return quick_landing;
  }
};

TEST_F(LandingFlightTest, LandsOnTrulySafeGround) {
  const LandingResult& result = landing().flown.result;
  ASSERT_EQ(result.outcome, Outcome::kSafe) << describe(result, 3);
  ASSERT_TRUE(result.footprint);
  EXPECT_LT(result.footprint->slope_deg, 10);
  EXPECT_LT(result.footprint->residual_m, 0.1);
  EXPECT_EQ(result.footprint->landable_share, 1);
  EXPECT_GE(result.footprint->clearance_m, LandFlightConfig().body_radius_m);
  EXPECT_LT(result.miss_m, 0.6);
  EXPECT_GT(result.frames_with_depth, 50);
  // On the ground: the IMU hangs a skid's height over it.
  const double ground_m = landing().flight.surface_truth().elevation_m(result.p_end.x(), result.p_end.y());
  EXPECT_NEAR(result.p_end.z() - ground_m, LandFlightConfig().skid_height_m, 0.15);
}

TEST_F(LandingFlightTest, TheBagHoldsWhatTheEngineGot) {
  const Rig rig = load_rig(quick().rig);
  // A bag without images is no flight log of this rig: the reader says so instead of reading on.
  EXPECT_THROW(FlightLog(landing().log(), rig, {}), DataError);
  EXPECT_GT(fs::file_size(landing().log()), 1000u * 1000u);
}

TEST_F(LandingFlightTest, ItsPicturesShowTheEnd) {
  const cv::Mat top = top_picture(landing().flown, landing().flight.surface_truth(), 0.85);
  const cv::Mat side = trajectory_picture(landing().flown, landing().flight.surface_truth());
  ASSERT_EQ(top.type(), CV_8UC3);
  ASSERT_EQ(side.type(), CV_8UC3);
  cv::Mat mark;
  cv::inRange(top, cv::Scalar(0, 255, 0), cv::Scalar(0, 255, 0), mark);
  EXPECT_GT(cv::countNonZero(mark), 10);  // the footprint's circle
}

/// The same landing, but a car comes to the confirmed site while the vehicle is on its last way down.
TEST_F(LandingFlightTest, ACarOnTheConfirmedSiteSendsItUpAgain) {
  const LandingResult& alone = landing().flown.result;
  ASSERT_EQ(alone.outcome, Outcome::kSafe);
  double final_s = 0;
  for (const auto& event : alone.events) {
    if (event.to == MissionState::kFinalDescent)
      final_s = static_cast<double>(event.t_ns) * 1e-9 - landing().flown.clock_start_s;
  }
  LandConfig config = quick();
  constexpr double kWay_m = 20;
  sim::VisitorConfig& car = config.world.visitor;
  car.kind = sim::VisitorKind::kCar;
  car.speed_mps = 8;
  car.to_x_m = alone.p_end.x();
  car.to_y_m = alone.p_end.y();
  car.from_x_m = car.to_x_m + kWay_m;
  car.from_y_m = car.to_y_m;
  car.begin_s = final_s + 1.5 - kWay_m / car.speed_mps;  // there a second and a half after the confirmation
  LandingFlight flight(config, config.world.seed, nullptr);
  const FlownLanding flown = flight.fly();
  bool up_again = false;
  for (const auto& event : flown.result.events)
    up_again =
        up_again || (event.from == MissionState::kFinalDescent && event.to == MissionState::kClimbAway);
  EXPECT_TRUE(up_again) << describe(flown.result, 3);
  EXPECT_NE(flown.result.outcome, Outcome::kUnsafe) << describe(flown.result, 3);
  EXPECT_NE(flown.result.outcome, Outcome::kCollided) << describe(flown.result, 3);
  if (flown.result.outcome != Outcome::kSafe) return;
  EXPECT_GT((flown.result.p_end - alone.p_end).head<2>().norm(), 2.5) << "half a car's length and the body";
  // The truth is that of the touchdown: the car stands there.
  const double top_m = flight.surface_truth().elevation_m(alone.p_end.x(), alone.p_end.y());
  EXPECT_GT(top_m, landing().flight.surface_truth().elevation_m(alone.p_end.x(), alone.p_end.y()) + 1);
}

/// It begins 10 m over the flat roof of a tall house, which is all that it sees.
TEST_F(LandingFlightTest, ARoofThatFillsTheViewIsNotLandedOn) {
  LandConfig config;
  config.rig = quick().rig;
  config.world.look = sim::Look::kUrban;
  config.world.seed = 104679;
  config.flight.images = false;
  LandingFlight flight(config, config.world.seed, nullptr);
  const LandingResult result = flight.fly().result;
  EXPECT_EQ(result.outcome, Outcome::kSafe) << describe(result, 3);
  const bool went_up = std::any_of(result.events.begin(), result.events.end(), [](const auto& event) {
    return event.reason.find("too near") != std::string::npos;
  });
  EXPECT_TRUE(went_up);
}

/// Short flights: gusts, noise, a first site, a failure.
FlownLanding without_position(std::int64_t seed) {
  LandConfig config = quick();
  config.mission.hold_timeout_s = 1;
  LandingFlight flight(config, seed, nullptr, {sim::find_fault("position lost"), 2.0, {}});
  return flight.fly();
}

TEST_F(LandingFlightTest, WithoutPositionItGivesUpAndSaysSoTheSameWayEveryTime) {
  const FlownLanding flown = without_position(200002);
  EXPECT_EQ(flown.result.outcome, Outcome::kGaveUp) << describe(flown.result, 3);
  EXPECT_FALSE(flown.result.footprint);
  EXPECT_NE(flown.result.reason.find("sensors stay failed"), std::string::npos) << flown.result.reason;
  EXPECT_EQ(row(without_position(200002)), row(flown));
  const FlownLanding other = without_position(200003);
  EXPECT_NE(other.result.p_end, flown.result.p_end);
}

TEST_F(LandingFlightTest, APositionThatComesBackIsWaitedFor) {
  const LandConfig config = quick();
  LandingFlight flight(config, config.world.seed, nullptr, {sim::find_fault("position lost"), 2.0, 4.0});
  const LandingResult result = flight.fly().result;
  EXPECT_EQ(result.outcome, Outcome::kSafe) << describe(result, 3);
  EXPECT_EQ(result.fault_kind(), "position lost for a while");
  const bool failed = std::any_of(result.events.begin(), result.events.end(), [](const auto& event) {
    return event.reason.find("position lost") != std::string::npos;
  });
  EXPECT_TRUE(failed);
  EXPECT_GT(result.duration_s, landing().flown.result.duration_s);
}

}  // namespace
}  // namespace alight::closed_loop
