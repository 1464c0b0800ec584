#include "calibrate/lidar/lidar_calibration.hpp"

#include <cstdio>
#include <memory>
#include <string>

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dataset/build/dataset_builder.hpp"
#include "foundation/errors.hpp"
#include "foundation/order_statistics.hpp"
#include "geometry/frames.hpp"
#include "sensors/messages/livox_custom_msg.hpp"
#include "sim/record/board_recorder.hpp"
#include "sim/record/simulated_log.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

sim::BoardSceneConfig scenes() {
  sim::BoardSceneConfig config;
  config.rig = (fs::path(ALIGHT_SOURCE_DIR) / "configs" / "rigs" / "paper.yaml").string();
  config.mounting = sim::Mounting::kRandom;
  config.seed = 3;
  config.scenes = 5;
  config.duration_s = 1;
  config.max_distance_m = 4;
  return config;
}

/// Five recordings before a random mounting, made once.
class LidarCalibrationTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = std::make_unique<test::ScratchFolder>();
    bags() = sim::record_boards(scenes(), folder() / "boards");
  }
  static void TearDownTestSuite() { scratch_.reset(); }

  static fs::path folder() { return scratch_->path(); }
  static std::vector<fs::path>& bags() {
    static std::vector<fs::path> paths;
    return paths;
  }
  static Rig rig() { return load_rig(folder() / "boards" / "rig.yaml"); }
  static Rig truth() { return load_rig(folder() / "boards" / "truth" / "rig.yaml"); }
  static Chessboard board() { return {6, 4, 0.12}; }
  /// Of all five, made once.
  static const LidarCalibration& calibrated() {
    static const LidarCalibration result = calibrate_lidar(bags(), rig(), board(), {});
    return result;
  }

  static std::string failure(const std::vector<fs::path>& logs, const Rig& used, const Chessboard& b,
                             const LidarCalibrationConfig& config = {}) {
    try {
      calibrate_lidar(logs, used, b, config);
    } catch (const DataError& e) {
      return e.what();
    }
    return "nothing was thrown";
  }

  inline static std::unique_ptr<test::ScratchFolder> scratch_;
};

TEST_F(LidarCalibrationTest, FindsTheExtrinsicsWithoutAStartAndKnowsTheirError) {
  const LidarCalibration& result = calibrated();
  const Eigen::Isometry3d T = truth().lidar0->T_camera_lidar;
  const Eigen::Isometry3d& found = result.extrinsics.T_camera_lidar;
  Vector6d error;
  error << T.translation() - found.translation(), rotation_log(T.linear() * found.linear().transpose());
  EXPECT_LT(error.head<3>().norm(), 0.01);
  EXPECT_LT(to_degrees(error.tail<3>().norm()), 0.1);
  for (int i = 0; i < 6; ++i) EXPECT_LT(std::abs(error[i]), 4 * result.extrinsics.sigma()[i]) << i;
  EXPECT_LT(result.extrinsics.sigma().head<3>().maxCoeff(), 0.01);
  EXPECT_FALSE(result.advice.empty());
  // Whoever writes the rig and reads it back has the same extrinsics.
  const Rig again = parse_rig(format_rig(result.rig), "again");
  EXPECT_TRUE(again.lidar0->T_camera_lidar.isApprox(found, 1e-5));
}

TEST_F(LidarCalibrationTest, DoesNotDependOnThreads) {
  LidarCalibrationConfig one;
  one.threads = 1;
  EXPECT_EQ(format_rig(calibrate_lidar(bags(), rig(), board(), one).rig), format_rig(calibrated().rig));
}

TEST_F(LidarCalibrationTest, DataSetsOfTheCalibratedAndTheTrueRigAgree) {
  Rig calibrated = truth();
  calibrated.lidar0->T_camera_lidar = LidarCalibrationTest::calibrated().extrinsics.T_camera_lidar;
  sim::SimConfig config;
  config.rig = (folder() / "boards" / "truth" / "rig.yaml").string();
  config.recorder.truth = false;
  config.sensors.camera.rate_hz = 2;
  config.flights[0].world.size_m = 90;
  config.flights[0].plan.kind = sim::PlanKind::kHover;
  config.flights[0].plan.start_height_m = 25;
  config.flights[0].plan.duration_s = 2.2;
  sim::FlightRecorder(config, folder()).record(config.flights[0]);
  DatasetConfig build;
  build.depth_map.every_nth_image = 1;
  const auto depth = [&](const Rig& used, const char* name) {
    const DatasetInfo info = build_dataset(build, used, {folder() / "flight.bag"}, folder() / name).info;
    const SampleRow row = read_samples(folder() / name, info.flights.at(0).name).at(1);
    return read_sample(folder() / name, info.flights.at(0), row, false).sparse.depth_m;
  };
  const cv::Mat true_m = depth(truth(), "true_rig");
  const cv::Mat found_m = depth(calibrated, "calibrated_rig");
  std::vector<float> differences_m;
  for (int v = 0; v < true_m.rows; ++v) {
    for (int u = 0; u < true_m.cols; ++u) {
      if (true_m.at<float>(v, u) > 0 && found_m.at<float>(v, u) > 0)
        differences_m.push_back(std::abs(true_m.at<float>(v, u) - found_m.at<float>(v, u)));
    }
  }
  ASSERT_GT(differences_m.size(), 10000u);
  const float median_m = median(differences_m);
  std::printf("median difference %.4f m over %zu pixels\n", static_cast<double>(median_m),
              differences_m.size());
  EXPECT_LT(median_m, 0.02F);
}

TEST_F(LidarCalibrationTest, SaysWhatToDoAboutTooFewBoards) {
  EXPECT_THAT(failure({bags()[0]}, rig(), board()), HasSubstr("only 1 of 1 recordings are usable, 3"));
}

TEST_F(LidarCalibrationTest, NoticesAWrongSquareSize) {
  EXPECT_THAT(failure({bags()[0]}, rig(), {6, 4, 0.10}), HasSubstr("check --square-m with a ruler"));
}

TEST_F(LidarCalibrationTest, NoticesAWrongBoardSize) {
  const std::string message = failure({bags()[0]}, rig(), {7, 5, 0.12});
  EXPECT_THAT(message, HasSubstr("no chessboard of 7x5 inner corners found"));
  EXPECT_THAT(message, HasSubstr("one less than squares each way"));
}

TEST_F(LidarCalibrationTest, RefusesAMovingScene) {
  sim::BoardSceneConfig moving = scenes();
  moving.scenes = 1;
  moving.drift_mps = 0.02;
  moving.renderer.edge_samples = 4;  // every image is rendered anew
  EXPECT_THAT(failure(sim::record_boards(moving, folder() / "moving"), rig(), board()),
              HasSubstr("the scene moves"));
}

TEST_F(LidarCalibrationTest, RefusesALidarWithoutReflectivity) {
  const fs::path even = folder() / "even.bag";
  {
    const rosbag::Bag from(bags()[0].string(), rosbag::bagmode::Read);
    rosbag::Bag to(even.string(), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(from)) {
      const auto points = message.instantiate<livox_ros_driver::CustomMsg>();
      if (points == nullptr) {
        to.write(message.getTopic(), message.getTime(), message);
        continue;
      }
      for (auto& point : points->points) point.reflectivity = 100;
      to.write(message.getTopic(), message.getTime(), *points);
    }
  }
  const std::string message = failure({even}, rig(), board());
  EXPECT_THAT(message, HasSubstr("even.bag: topic /livox/lidar"));
  EXPECT_THAT(message, HasSubstr("have no reflectivity"));
  EXPECT_THAT(message, HasSubstr("record livox_ros_driver/CustomMsg"));
}

TEST_F(LidarCalibrationTest, NeedsTheRigToNameALidar) {
  Rig without = rig();
  without.lidar0.reset();
  EXPECT_THROW(calibrate_lidar(bags(), without, board(), {}), ConfigError);
}

}  // namespace
}  // namespace alight
