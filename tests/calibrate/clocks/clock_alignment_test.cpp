#include "calibrate/clocks/clock_alignment.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <opencv2/core.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "sim/record/simulated_flight.hpp"
#include "sim/record/simulated_log.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/tools/tool_runner.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr double kTolerance_s = 0.005;
constexpr double kCameraClock_s = 0.03;  // of the recorded flight: stamp - true time
constexpr double kLidarClock_s = -0.02;

/// Over a village in legs that turn to either side, then down.
sim::SimConfig flight_config() {
  sim::SimConfig config;
  config.rig = (fs::path(ALIGHT_SOURCE_DIR) / "configs" / "rigs" / "paper.yaml").string();
  config.sensors.camera.rate_hz = 4;
  config.sensors.camera.clock_offset_s = kCameraClock_s;
  config.sensors.lidar.clock_offset_s = kLidarClock_s;
  config.renderer.edge_samples = 1;
  config.recorder.truth = false;
  sim::FlightConfig& flight = config.flights.front();
  flight.seed = 501;
  flight.world.look = sim::Look::kVillage;
  flight.world.seed = 71;
  flight.plan.start_height_m = 20;
  flight.plan.speed_mps = 4;
  flight.plan.hover_s = 0.5;
  flight.plan.search_s = 9;
  flight.plan.leg_s = 2.5;
  flight.plan.end_height_m = 12;
  flight.plan.end_hover_s = 0.5;
  return config;
}

/// One flight, recorded once, both of whose sensors' clocks are off.
class ClockAlignmentTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (scratch_) return;
    scratch_ = std::make_unique<test::ScratchFolder>();
    const sim::SimConfig config = flight_config();
    sim::FlightRecorder(config, folder()).record(config.flights.front());
  }
  static fs::path folder() { return scratch_->path(); }
  static fs::path log() { return folder() / "flight.bag"; }
  static Rig true_rig() { return sim::true_rig(load_rig(flight_config().rig), flight_config().sensors); }
  static FlightViews read(const fs::path& bag, const Rig& rig) { return read_flight_views(bag, rig, {}, {}); }
  /// A hover on the spot, without the sway of a real one.
  static FlightViews hover() {
    sim::SimConfig config = flight_config();
    sim::FlightConfig& flight = config.flights.front();
    flight.name = "hover";
    flight.plan.kind = sim::PlanKind::kHover;
    flight.plan.duration_s = 5;
    flight.plan.sway_m = 0;
    sim::FlightRecorder(config, folder()).record(flight);
    return read(folder() / "hover.bag", true_rig());
  }

  inline static std::unique_ptr<test::ScratchFolder> scratch_;  // until the program ends
};

/// Milliseconds by which the rig file is wrong: what has to be found.
struct Offsets {
  int camera_ms;
  int lidar_ms;
};

class WrongTimeShifts : public ClockAlignmentTest, public ::testing::WithParamInterface<Offsets> {};

TEST_P(WrongTimeShifts, AreFoundWithinFiveMilliseconds) {
  const double camera_s = 1e-3 * GetParam().camera_ms;
  const double lidar_s = 1e-3 * GetParam().lidar_ms;
  Rig rig = true_rig();
  rig.cam0.timeshift_cam_imu_s -= camera_s;
  rig.cam1->timeshift_cam_imu_s -= camera_s;
  rig.lidar0->timeshift_s -= lidar_s;
  const ClockAlignment alignment = align_clocks(read(log(), rig), {});
  EXPECT_TRUE(alignment.camera.told) << alignment.camera.reason;
  EXPECT_NEAR(alignment.camera.offset_s, camera_s, kTolerance_s);
  EXPECT_TRUE(alignment.lidar.told) << alignment.lidar.reason;
  EXPECT_NEAR(alignment.lidar.offset_s, lidar_s, kTolerance_s);
  EXPECT_GT(alignment.correlation, 0.98);
  std::printf("camera %+.1f ms off by %+.1f +- %.1f, LiDAR %+.1f ms off by %+.1f +- %.1f\n", 1e3 * camera_s,
              1e3 * (alignment.camera.offset_s - camera_s), 1e3 * alignment.camera.sigma_s, 1e3 * lidar_s,
              1e3 * (alignment.lidar.offset_s - lidar_s), 1e3 * alignment.lidar.sigma_s);
}
#ifdef ALIGHT_CLOCKS_SHORT
const auto kOffsets = ::testing::Values(Offsets{-80, 20});
#else
const auto kOffsets =
    ::testing::Values(Offsets{-80, 20}, Offsets{-35, 80}, Offsets{0, 0}, Offsets{20, -80}, Offsets{80, -35});
#endif
INSTANTIATE_TEST_SUITE_P(Offsets, WrongTimeShifts, kOffsets, [](const auto& info) {
  std::string name =
      "camera_" + std::to_string(info.param.camera_ms) + "_lidar_" + std::to_string(info.param.lidar_ms);
  std::replace(name.begin(), name.end(), '-', 'm');
  return name;
});

TEST_F(ClockAlignmentTest, TheToolPrintsTheLinesForTheRigFile) {
  const fs::path picture = folder() / "clocks.png";
  const test::ToolRun run = test::run_tool("alight-dataset -q align " + log().string() + " --rig " +
                                           flight_config().rig + " --picture " + picture.string());
  EXPECT_EQ(run.exit_code, 0) << run.out;
  EXPECT_GT(fs::file_size(picture), 1000u);
  double camera_s = 0;
  double right_s = 0;
  double lidar_s = 0;
  const std::size_t yaml = run.out.find("cam0:");
  ASSERT_NE(yaml, std::string::npos) << run.out;
  ASSERT_EQ(std::sscanf(
                run.out.c_str() + yaml,
                "cam0:\n  timeshift_cam_imu: %lf\ncam1:\n  timeshift_cam_imu: %lf\nlidar0:\n  timeshift: %lf",
                &camera_s, &right_s, &lidar_s),
            3)
      << run.out;
  EXPECT_NEAR(camera_s, -kCameraClock_s, kTolerance_s);
  EXPECT_EQ(right_s, camera_s);
  EXPECT_NEAR(lidar_s, -kLidarClock_s, kTolerance_s);
}

TEST_F(ClockAlignmentTest, AHoverOnTheSpotTellsNothing) {
  const ClockAlignment alignment = align_clocks(hover(), {});
  EXPECT_FALSE(alignment.camera.told);
  EXPECT_THAT(alignment.camera.reason, HasSubstr("fly curves"));
  EXPECT_FALSE(alignment.lidar.told);
}

TEST_F(ClockAlignmentTest, ImagesWithoutTextureTellNothing) {
  FlightViews blank = read(log(), true_rig());
  cv::RNG random(3);
  for (ExposureView& view : blank.views) {
    view.left = cv::Mat(view.left.size(), CV_8UC1);
    random.fill(view.left, cv::RNG::NORMAL, 120, 2);  // the sensor's noise
  }
  const ClockAlignment alignment = align_clocks(blank, {});
  EXPECT_FALSE(alignment.camera.told);
  EXPECT_THAT(alignment.camera.reason, HasSubstr("in daylight"));
  EXPECT_FALSE(alignment.lidar.told);
  EXPECT_THAT(alignment.lidar.reason, HasSubstr("no better than by chance"));
}

TEST_F(ClockAlignmentTest, LevelGroundTellsTheCamerasClockAlone) {
  FlightViews level = read(log(), true_rig());
  level.edges.clear();
  const ClockAlignment alignment = align_clocks(level, {});
  EXPECT_TRUE(alignment.camera.told) << alignment.camera.reason;
  EXPECT_FALSE(alignment.lidar.told);
  EXPECT_THAT(alignment.lidar.reason, HasSubstr("only 0 depth edges"));
}

TEST_F(ClockAlignmentTest, PosesOfAnotherFlightTellNothing) {
  FlightViews wrong = read(log(), true_rig());
  Trajectory backwards(0.25);
  const std::int64_t begin_ns = *wrong.trajectory.begin_ns();
  const std::int64_t end_ns = *wrong.trajectory.end_ns();
  for (std::int64_t t_ns = begin_ns; t_ns <= end_ns; t_ns += kNanosecondsPerSecond / 100) {
    const auto T = wrong.trajectory.T_world_imu(begin_ns + end_ns - t_ns);
    if (!T) continue;
    backwards.add_attitude(t_ns, Eigen::Quaterniond(T->linear()));
    backwards.add_position(t_ns, T->translation());
  }
  wrong.trajectory = backwards;
  const ClockAlignment alignment = align_clocks(wrong, {});
  EXPECT_FALSE(alignment.camera.told);
  EXPECT_THAT(alignment.camera.reason, HasSubstr("check the topics of attitude and position"));
  EXPECT_FALSE(alignment.lidar.told);
}

}  // namespace
}  // namespace alight
