#include "calibrate/check/rig_check.hpp"

#include <fstream>
#include <memory>

#include <opencv2/imgproc.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calibrate/check/rig_check_report.hpp"
#include "foundation/errors.hpp"
#include "geometry/frames.hpp"
#include "sim/record/simulated_log.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/tools/tool_runner.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kTurn_deg = 0.5;

sim::SimConfig checked_flight() {
  sim::SimConfig config;
  config.rig = (fs::path(ALIGHT_SOURCE_DIR) / "configs" / "rigs" / "paper.yaml").string();
  config.sensors.camera.rate_hz = 4;
  config.renderer.edge_samples = 1;
  config.recorder.truth = false;
  sim::FlightConfig& flight = config.flights.front();
  flight.seed = 21;
  flight.world.look = sim::Look::kForest;
  flight.world.seed = 5;
  flight.world.size_m = 90;
  flight.plan.kind = sim::PlanKind::kStraight;
  flight.plan.start_x_m = -12;
  flight.plan.start_height_m = 26;
  flight.plan.heading_deg = 0;
  flight.plan.duration_s = 7;
  return config;
}

/// One flight over a wood, recorded and read once for all suites.
class RigCheckTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (scratch_) return;
    scratch_ = std::make_unique<test::ScratchFolder>();
    const sim::SimConfig config = checked_flight();
    sim::FlightRecorder(config, folder()).record(config.flights.front());
  }

  static fs::path folder() { return scratch_->path(); }
  static Rig true_rig() { return load_rig(checked_flight().rig); }
  static FlightViews read(const Rig& rig) { return read_flight_views(folder() / "flight.bag", rig, {}, {}); }
  /// With the true rig.
  static const FlightViews& flight() {
    static const FlightViews views = read(true_rig());
    return views;
  }
  /// Searches less far than a user's check: half of the time.
  static RigCheckConfig config() {
    RigCheckConfig config;
    config.edges.max_turn_deg = 1.5;
    return config;
  }
  static Eigen::Isometry3d turn(int axis) {
    return motion_of(to_radians(kTurn_deg) * Eigen::Vector3d::Unit(axis), Eigen::Vector3d::Zero());
  }
  /// `alight-calibrate check` on the flight.
  static test::ToolRun run(const Rig& rig, const std::string& name) {
    write_file(folder() / (name + ".yaml"), format_rig(rig));
    return test::run_tool("alight-calibrate check --log " + (folder() / "flight.bag").string() + " --rig " +
                          (folder() / (name + ".yaml")).string() + " --report " + (folder() / name).string());
  }
  static void write_file(const fs::path& path, const std::string& content) { std::ofstream(path) << content; }

  inline static std::unique_ptr<test::ScratchFolder> scratch_;  // until the program ends
};

TEST_F(RigCheckTest, ATrueRigIsGood) {
  const RigCheck check = check_rig(flight(), config());
  EXPECT_EQ(check.verdict, RigVerdict::kGood) << format_rig_check(check);
  EXPECT_TRUE(check.reasons.empty());
  ASSERT_EQ(check.axes.size(), 9u);
  for (const AxisCheck& axis : check.axes) EXPECT_FALSE(axis.moved) << axis.name;
  EXPECT_NEAR(check.edges.score, check.edges.best_score, 0.02);
}

class TurnedLidar : public RigCheckTest, public ::testing::WithParamInterface<int> {};

TEST_P(TurnedLidar, HasMovedAndIsToldHowToTurnBack) {
  const auto axis = static_cast<std::size_t>(GetParam());
  FlightViews turned = flight();
  turned.rig.T_camera_lidar = turn(GetParam()) * flight().rig.T_camera_lidar;
  const RigCheck check = check_rig(turned, config());
  EXPECT_EQ(check.verdict, RigVerdict::kMoved) << format_rig_check(check);
  EXPECT_TRUE(check.axes[axis].moved);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(check.axes[i].by, i == axis ? -kTurn_deg : 0, 0.15) << i;
  for (std::size_t i = 6; i < 9; ++i) EXPECT_FALSE(check.axes[i].moved) << "the cameras have not";
  EXPECT_GT(check.edges.best_score, check.edges.score);
}
INSTANTIATE_TEST_SUITE_P(Axes, TurnedLidar, ::testing::Values(0, 1, 2));

class TurnedCamera : public RigCheckTest, public ::testing::WithParamInterface<int> {};

TEST_P(TurnedCamera, HasMovedAndIsToldHowToTurnBack) {
  const auto axis = static_cast<std::size_t>(6 + GetParam());
  Rig rig = true_rig();
  rig.T_cam1_cam0 = turn(GetParam()) * rig.T_cam1_cam0;
  const RigCheck check = check_rig(read(rig), config());
  EXPECT_EQ(check.verdict, RigVerdict::kMoved) << format_rig_check(check);
  for (std::size_t i = 6; i < 9; ++i) {
    EXPECT_EQ(check.axes[i].moved, i == axis) << i;
    EXPECT_NEAR(check.axes[i].by, i == axis ? -kTurn_deg : 0, 0.03) << i;
  }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(check.axes[i].moved) << "the LiDAR has not";
}
INSTANTIATE_TEST_SUITE_P(Axes, TurnedCamera, ::testing::Values(0, 1, 2));

TEST_F(RigCheckTest, AShiftIsNoticed) {
  FlightViews shifted = flight();
  shifted.rig.T_camera_lidar = motion_of(Eigen::Vector3d::Zero(), {0.3, 0, 0}) * flight().rig.T_camera_lidar;
  const RigCheck check = check_rig(shifted, config());
  EXPECT_EQ(check.verdict, RigVerdict::kMoved) << format_rig_check(check);
  // From 20 m above the trees the shift looks like a turn about y that brings points back by as much.
  EXPECT_LT(check.axes[1].by, -0.3);
}

TEST_F(RigCheckTest, CannotTellWithoutTexture) {
  FlightViews blank = flight();
  cv::RNG random(5);
  for (ExposureView& view : blank.views) {
    view.left = cv::Mat(view.left.size(), CV_8UC1);
    random.fill(view.left, cv::RNG::NORMAL, 120, 2);  // the sensor's noise
    view.right = view.left.clone();
    random.fill(view.right, cv::RNG::NORMAL, 120, 2);
  }
  const RigCheck check = check_rig(blank, config());
  EXPECT_EQ(check.verdict, RigVerdict::kCannotTell) << format_rig_check(check);
  for (const AxisCheck& axis : check.axes) EXPECT_FALSE(axis.judged || axis.moved) << axis.name;
  EXPECT_THAT(check.reasons, Contains(HasSubstr("nowhere better than by chance")));
  EXPECT_THAT(check.reasons, Contains(HasSubstr("too dark")));
}

TEST_F(RigCheckTest, CannotTellFromImagesOfAnotherTime) {
  FlightViews mixed = flight();
  const std::size_t half = mixed.views.size() / 2;
  for (std::size_t i = 0; i < half; ++i) std::swap(mixed.views[i].left, mixed.views[i + half].left);
  const RigCheck check = check_rig(mixed, config());
  EXPECT_EQ(check.verdict, RigVerdict::kCannotTell) << format_rig_check(check);
  EXPECT_THAT(check.reasons, Contains(HasSubstr("do not belong together")));
}

TEST_F(RigCheckTest, CannotTellWithoutDepthEdges) {
  FlightViews flat = flight();
  flat.edges.resize(100);
  const RigCheck check = check_rig(flat, config());
  EXPECT_EQ(check.verdict, RigVerdict::kCannotTell);
  EXPECT_THAT(check.reasons, Contains(HasSubstr("fly over houses, trees or boulders")));
  EXPECT_FALSE(draw_rig_check(flat, check, config()).empty());
}

TEST_F(RigCheckTest, MonoRigsAreJudgedByTheLidarAlone) {
  Rig mono = true_rig();
  mono.cam1.reset();
  const RigCheck check = check_rig(read(mono), config());
  EXPECT_EQ(check.verdict, RigVerdict::kGood) << format_rig_check(check);
  EXPECT_EQ(check.axes.size(), 6u);
}

TEST_F(RigCheckTest, TheToolTellsByItsExitCode) {
  const test::ToolRun good = run(true_rig(), "good");
  EXPECT_EQ(good.exit_code, 0) << good.out;
  EXPECT_THAT(good.out, HasSubstr("verdict: good"));
  for (const char* file : {"report.txt", "report.json", "edges.png"})
    EXPECT_GT(fs::file_size(folder() / "good" / file), 100u) << file;
  Rig turned = true_rig();
  turned.lidar0->T_camera_lidar = turn(0) * turned.lidar0->T_camera_lidar;
  const test::ToolRun moved = run(turned, "moved");
  EXPECT_EQ(moved.exit_code, 3) << moved.out;
  EXPECT_THAT(moved.out, HasSubstr("LiDAR turn about x: -0."));
  Rig without = true_rig();
  without.lidar0.reset();
  const test::ToolRun refused = run(without, "without");
  EXPECT_EQ(refused.exit_code, 2) << refused.out;
  EXPECT_THAT(refused.out, HasSubstr("has no lidar0"));
  EXPECT_FALSE(fs::exists(folder() / "without"));
}

TEST_F(RigCheckTest, TheToolCannotTellFromAFlightThatIsTooShort) {
  sim::SimConfig config = checked_flight();
  config.flights.front().name = "short";
  config.flights.front().plan.duration_s = 0.8;
  sim::FlightRecorder(config, folder()).record(config.flights.front());
  const test::ToolRun run = test::run_tool(
      "alight-calibrate check --log " + (folder() / "short.bag").string() + " --rig configs/rigs/paper.yaml");
  EXPECT_EQ(run.exit_code, 4) << run.out;
  EXPECT_THAT(run.out, HasSubstr("verdict: cannot tell"));
}

}  // namespace
}  // namespace alight
