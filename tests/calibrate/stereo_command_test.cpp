#include <filesystem>
#include <memory>

#include <opencv2/imgcodecs.hpp>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CompressedImage.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "geometry/rig/rig.hpp"
#include "sim/record/board_recorder.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/tools/tool_runner.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* kLeft = "/mynteye/left/image_raw";
constexpr const char* kRight = "/mynteye/right/image_raw";

/// Seven views of a board, one pair of images each, in one bag: what a user records who walks about with a board.
class StereoCommand : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = std::make_unique<test::ScratchFolder>();
    sim::BoardSceneConfig scenes;
    scenes.rig = (fs::path(ALIGHT_SOURCE_DIR) / "configs" / "rigs" / "paper.yaml").string();
    scenes.seed = 8;
    scenes.scenes = 7;
    scenes.duration_s = 0.2;
    scenes.min_distance_m = 1.2;
    scenes.max_distance_m = 1.8;
    scenes.board.square_m = 0.08;
    scenes.max_roll_deg = 20;
    scenes.sensors.camera.format = sim::ImageFormat::kJpeg;
    join(sim::record_boards(scenes, folder() / "views"));
  }
  static void TearDownTestSuite() { scratch_.reset(); }
  static fs::path folder() { return scratch_->path(); }
  static fs::path log() { return folder() / "boards.bag"; }

  static void join(const std::vector<fs::path>& bags) {
    rosbag::Bag joined(log().string(), rosbag::bagmode::Write);
    for (std::size_t i = 0; i < bags.size(); ++i) {
      const rosbag::Bag one(bags[i].string(), rosbag::bagmode::Read);
      for (const rosbag::MessageInstance& message : rosbag::View(one)) {
        auto image = message.instantiate<sensor_msgs::CompressedImage>();
        if (image == nullptr) continue;
        image->header.stamp += ros::Duration(static_cast<double>(i));
        joined.write(message.getTopic(), message.getTime() + ros::Duration(static_cast<double>(i)), *image);
      }
    }
  }
  static test::ToolRun run(const std::string& arguments) {
    return test::run_tool("alight-calibrate stereo --board 6x4 --square-m 0.08 " + arguments);
  }

  inline static std::unique_ptr<test::ScratchFolder> scratch_;
};

TEST_F(StereoCommand, ReadsItsViewsFromTheTopicsOfALog) {
  const fs::path output = folder() / "rig.yaml";
  const test::ToolRun result = run("--log " + log().string() + " --left-topic " + kLeft + " --right-topic " +
                                   kRight + " --set radtan_coefficients=4 --output " + output.string());
  ASSERT_EQ(result.exit_code, 0) << result.out;
  EXPECT_THAT(result.out, HasSubstr("over 7 views"));
  const Rig rig = load_rig(output);
  EXPECT_EQ(rig.cam0.topic, kLeft);
  EXPECT_EQ(rig.cam1->topic, kRight);
  EXPECT_NEAR(rig.T_cam1_cam0.translation().x(), -0.08, 0.002);
  EXPECT_NEAR(rig.cam0.camera.intrinsics.fx_px, 440, 8);
}

TEST_F(StereoCommand, NeedsBothTopicsAndFindsThem) {
  const std::string output = " --output " + (folder() / "none.yaml").string();
  const test::ToolRun missing = run("--log " + log().string() + " --left-topic " + kLeft + output);
  EXPECT_EQ(missing.exit_code, 2) << missing.out;
  EXPECT_THAT(missing.out, HasSubstr("--left-topic and --right-topic"));
  const test::ToolRun wrong =
      run("--log " + log().string() + " --left-topic " + kLeft + " --right-topic /right/image" + output);
  EXPECT_EQ(wrong.exit_code, 1) << wrong.out;
  EXPECT_THAT(wrong.out, HasSubstr("no topic /right/image"));
  EXPECT_THAT(wrong.out, HasSubstr(kRight));  // what the bag has
  EXPECT_FALSE(fs::exists(folder() / "none.yaml"));
}

TEST_F(StereoCommand, ImagesHaveToBePairs) {
  cv::imwrite((folder() / "l1.png").string(), cv::Mat::zeros(48, 64, CV_8UC1));
  cv::imwrite((folder() / "r1.png").string(), cv::Mat::zeros(48, 64, CV_8UC1));
  cv::imwrite((folder() / "r2.png").string(), cv::Mat::zeros(48, 64, CV_8UC1));
  const test::ToolRun result =
      run("--left '" + (folder() / "l*.png").string() + "' --right '" + (folder() / "r*.png").string() +
          "' --output " + (folder() / "none.yaml").string());
  EXPECT_EQ(result.exit_code, 2) << result.out;
  EXPECT_THAT(result.out, HasSubstr("matches 1 files, --right 2"));
}

}  // namespace
}  // namespace alight
