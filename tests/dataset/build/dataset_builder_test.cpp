#include "dataset/build/dataset_builder.hpp"

#include <opencv2/imgcodecs.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "geometry/depth_map.hpp"
#include "geometry/rig/find_rig_file.hpp"
#include "tests/sensors/test_flight.hpp"
#include "tests/support/file_text.hpp"

namespace alight::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class DatasetBuilder : public ::testing::Test {
 protected:
  DatasetBuilder() {
    config_.depth_map.crop_px = 32;
    config_.depth_map.every_nth_image = 1;
    write_flight(log_);
  }
  DatasetInfo build(const fs::path& output, const Rig& rig = small_rig()) {
    return build_dataset(config_, rig, {log_}, output).info;
  }
  /// True depth for all images of the log: the column's number in metres.
  void write_truth(std::int64_t stamp_shift_ns = 0) {
    cv::Mat depth_m(48, 64, CV_32FC1);
    for (int u = 0; u < depth_m.cols; ++u) depth_m.col(u).setTo(u + 1);
    const fs::path folder = folder_.path() / "flight.truth" / "depth";
    fs::create_directories(folder);
    for (int i = 0; i < 30; ++i) {
      const std::int64_t t_ns = kStart_ns + 50'000'000 + i * 100'000'000LL + stamp_shift_ns;
      cv::imwrite((folder / (std::to_string(t_ns) + ".png")).string(), encode_depth(depth_m));
    }
  }
  ScratchFolder folder_;
  fs::path log_ = folder_.path() / "flight.bag";
  fs::path output_ = folder_.path() / "data";
  DatasetConfig config_;
};

TEST_F(DatasetBuilder, ALogBecomesSamples) {
  const DatasetInfo built = build(output_);
  const DatasetInfo info = read_dataset_info(output_);
  ASSERT_EQ(info.flights.size(), 1u);
  EXPECT_EQ(info.flights[0].name, "flight");
  EXPECT_EQ(info.flights[0].dropped, built.flights[0].dropped);
  EXPECT_FALSE(info.flights[0].has_dense);
  EXPECT_EQ(info.accumulation_s, 2.0);
  EXPECT_TRUE(parse_config<DatasetConfig>(info.config, "stored").depth_map.crop_px == 32);
  const auto rows = read_samples(output_, "flight");
  ASSERT_EQ(rows.size(), 30u);  // the first LiDAR packet lies before the first pose; all images have others
  EXPECT_EQ(rows[0].previous, -1);
  EXPECT_EQ(rows[0].next, 1);
  EXPECT_EQ(rows[29].next, -1);
  EXPECT_NEAR(rows[5].height_m, 10, 1e-9);
  for (const SampleRow& row : rows) {
    const Sample sample = read_sample(output_, info.flights[0], row, true);
    EXPECT_EQ(sample.left.size(), cv::Size(32, 32));
    EXPECT_EQ(sample.sparse.count(), row.pixels);
    double max_m = 0;
    cv::minMaxLoc(sample.sparse.depth_m, nullptr, &max_m);
    EXPECT_NEAR(max_m, 10 - 0.03,
                1.0 / 256);  // level ground 10 m under the LiDAR, which sits 3 cm above the camera
  }
}

TEST_F(DatasetBuilder, RebuildingGivesTheSameBytes) {
  write_truth();
  build(output_);
  build(folder_.path() / "again");
  const auto first = read_tree(output_);
  EXPECT_EQ(first.size(), 30u * 5 + 3);
  EXPECT_EQ(first, read_tree(folder_.path() / "again"));
}

TEST_F(DatasetBuilder, TrueDepthIsCroppedAlike) {
  write_truth();
  const DatasetInfo info = build(output_);
  ASSERT_TRUE(info.flights[0].has_dense);
  const auto rows = read_samples(output_, "flight");
  const Sample sample = read_sample(output_, info.flights[0], rows[3], true);
  EXPECT_EQ(sample.dense_m.at<float>(0, 0), 17);  // column 16 of 64
  EXPECT_EQ(sample.dense_m.size(), cv::Size(32, 32));
}

TEST_F(DatasetBuilder, TrueDepthIsFoundByTheStampInTheLogAlsoWithAShiftedClock) {
  write_truth();
  Rig rig = small_rig();
  rig.cam0.timeshift_cam_imu_s = 0.003;
  EXPECT_TRUE(build(output_, rig).flights[0].has_dense);
}

TEST_F(DatasetBuilder, MissingTrueDepthIsNamed) {
  write_truth(1);
  EXPECT_THAT(message_of<DataError>([&] { build(output_); }),
              AllOf(HasSubstr("flight.truth"), HasSubstr(".png")));
  EXPECT_FALSE(fs::exists(output_));
}

TEST_F(DatasetBuilder, TrueDepthIsLeftOutWhereTheRigNeedsRectification) {
  write_truth();
  Rig rig = small_mono_rig();
  rig.cam0.camera.distortion_model = DistortionModel::kRadtan;
  rig.cam0.camera.distortion_coeffs = {-0.1, 0.01, 0, 0};
  const DatasetInfo info = build(output_, rig);
  EXPECT_FALSE(info.flights[0].has_dense);
  EXPECT_FALSE(info.flights[0].has_right);
}

TEST_F(DatasetBuilder, AnInterruptedBuildLeavesNothing) {
  BuildOptions options;
  options.progress = [](std::int64_t done, std::int64_t total) {
    if (done > total / 3) throw std::runtime_error("interrupted");
  };
  EXPECT_THROW(build_dataset(config_, small_rig(), {log_}, output_, options), std::runtime_error);
  EXPECT_FALSE(fs::exists(output_));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1);  // the log
}

TEST_F(DatasetBuilder, ExistingOutputIsKept) {
  fs::create_directories(output_);
  write_bytes(output_ / "mine.txt", "mine");
  EXPECT_THAT(message_of<DataError>([&] { build(output_); }), HasSubstr("exists"));
  EXPECT_EQ(test::file_text(output_ / "mine.txt"), "mine");
}

TEST_F(DatasetBuilder, ALogWithoutASampleSaysWhatWasDropped) {
  config_.depth_map.min_pixels = 1'000'000;
  EXPECT_THAT(message_of<DataError>([&] { build(output_); }),
              AllOf(HasSubstr("flight.bag"), HasSubstr("30 images with too few depth pixels")));
}

TEST_F(DatasetBuilder, UnusableInputsAreConfigurationErrors) {
  Rig rig = small_rig();
  rig.lidar0.reset();
  EXPECT_THAT(message_of<ConfigError>([&] { build(output_, rig); }), HasSubstr("lidar0"));
  rig = small_rig();
  rig.cam0.T_camera_imu.reset();
  EXPECT_THAT(message_of<ConfigError>([&] { build(output_, rig); }), HasSubstr("T_cam_imu"));
  EXPECT_THAT(message_of<ConfigError>([&] { build_dataset(config_, small_rig(), {}, output_); }),
              HasSubstr("--log"));
  EXPECT_THAT(message_of<ConfigError>([&] { build_dataset(config_, small_rig(), {log_, log_}, output_); }),
              HasSubstr("named flight"));
}

TEST_F(DatasetBuilder, TheRigIsFoundFromTheConfigurationFile) {
  const fs::path configs = folder_.path() / "configs" / "dataset";
  fs::create_directories(configs);
  fs::create_directories(folder_.path() / "configs" / "rigs");
  write_bytes(configs / "default.yaml", "");
  write_bytes(folder_.path() / "configs" / "rigs" / "only_here.yaml", "");
  EXPECT_EQ(find_rig_file("configs/rigs/only_here.yaml", configs / "default.yaml"),
            folder_.path() / "configs" / "rigs" / "only_here.yaml");
  EXPECT_THAT(
      message_of<ConfigError>([&] { find_rig_file("configs/rigs/nowhere.yaml", configs / "default.yaml"); }),
      HasSubstr("configs/rigs/nowhere.yaml: is not in "));
}

TEST(ShippedDatasetConfig, LoadsAndNamesARigThatLoads) {
  const fs::path file = fs::path(ALIGHT_SOURCE_DIR) / "configs" / "dataset" / "default.yaml";
  const auto config = load_config<DatasetConfig>(file);
  EXPECT_EQ(print_config(config),
            print_config(DatasetConfig{}));  // the defaults in code are the shipped ones
  EXPECT_NO_THROW(load_rig(find_rig_file(config.rig, file)));
}

}  // namespace
}  // namespace alight::testing
