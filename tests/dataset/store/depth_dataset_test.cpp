#include "dataset/store/depth_dataset.hpp"

#include <cmath>
#include <fstream>

#include <opencv2/imgcodecs.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr int kWidth = 7;
constexpr int kHeight = 5;

/// Two flights on disk: "a" stereo with true depth and three samples, "b" mono with one sample.
class DepthDatasetTest : public ::testing::Test {
 protected:
  DepthDatasetTest() {
    DatasetInfo info;
    info.rig.intrinsics = {440, 441, 3, 2, kWidth, kHeight};
    info.rig.baseline_m = 0.08;
    info.window_before_s = info.window_after_s = 1;
    info.flights = {{"a", 3, {}, true, true}, {"b", 1, {}, false, false}};
    for (const FlightEntry& flight : info.flights) write_flight(flight);
    write_dataset_info(dir_, info);
  }

  /// Sample i: blue 10 + i, green 20, red 30; depth 8 + i at (u, v) = (4, 1), 0.25 s before the image.
  void write_flight(const FlightEntry& flight) {
    create_flight_folders(dir_, flight);
    std::vector<SampleRow> rows;
    for (int i = 0; i < flight.samples; ++i) {
      Sample sample;
      sample.left = cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar(10 + i, 20, 30));
      if (flight.has_right) sample.right = cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar(40, 50, 60));
      sample.sparse = SparseDepth::empty({kWidth, kHeight});
      sample.sparse.depth_m.at<float>(1, 4) = static_cast<float>(8 + i);
      sample.sparse.offset_us.at<std::int32_t>(1, 4) = -250'000;
      if (flight.has_dense) sample.dense_m = cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(9));
      write_sample(dir_, flight, i, sample, 1);
      SampleRow row;
      row.index = i;
      row.t_ns = i;
      row.T_world_camera = pose(i);
      row.previous = i - 1;
      row.next = i + 1 < flight.samples ? i + 1 : -1;
      row.height_m = flight.name == "a" ? 30 + i : std::nan("");
      rows.push_back(row);
    }
    write_samples(dir_, flight.name, rows);
  }
  static Eigen::Isometry3d pose(int i) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(0.1 * i, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    T.translation() << 100.0 + i, 200.0, 30.0;
    return T;
  }
  std::string get_error(std::size_t index, DepthDatasetOptions options = {}) {
    DepthDataset dataset(dir_, std::move(options));
    try {
      dataset.get(index);
    } catch (const DataError& e) {
      return e.what();
    }
    return {};
  }
  const test::ScratchFolder scratch_;
  const fs::path dir_ = scratch_.path();
};

TEST_F(DepthDatasetTest, ShapesAndTypes) {
  DepthDataset dataset(dir_);
  ASSERT_EQ(dataset.size().value(), 4u);
  const DepthSample sample = dataset.get(1);
  for (const torch::Tensor& image : {sample.left, sample.right, sample.previous, sample.next}) {
    EXPECT_EQ(image.sizes(), torch::IntArrayRef({3, kHeight, kWidth}));
    EXPECT_EQ(image.scalar_type(), torch::kFloat32);
    EXPECT_TRUE(image.is_contiguous());
  }
  EXPECT_EQ(sample.sparse.sizes(), torch::IntArrayRef({1, kHeight, kWidth}));
  EXPECT_EQ(sample.offset_s.sizes(), torch::IntArrayRef({1, kHeight, kWidth}));
  EXPECT_EQ(sample.T_previous_camera.sizes(), torch::IntArrayRef({4, 4}));
  EXPECT_EQ(sample.index, 1);
  EXPECT_EQ(sample.baseline_m, 0.08);
  EXPECT_EQ(sample.height_m, 31);
}

TEST_F(DepthDatasetTest, ImagesAreRgbFromZeroToOne) {
  DepthDataset dataset(dir_);
  const DepthSample sample = dataset.get(1);
  const auto mean = sample.left.mean({1, 2});
  EXPECT_NEAR(mean[0].item<float>(), 30.0 / 255, 1e-6);
  EXPECT_NEAR(mean[1].item<float>(), 20.0 / 255, 1e-6);
  EXPECT_NEAR(mean[2].item<float>(), 11.0 / 255, 1e-6);
  EXPECT_NEAR(sample.previous[2][0][0].item<float>(), 10.0 / 255, 1e-6);
  EXPECT_NEAR(sample.next[2][0][0].item<float>(), 12.0 / 255, 1e-6);
  EXPECT_NEAR(sample.right[0][0][0].item<float>(), 60.0 / 255, 1e-6);
}

TEST_F(DepthDatasetTest, DepthStandsWhereItWasWithItsOffset) {
  DepthDataset dataset(dir_);
  const DepthSample sample = dataset.get(2);
  EXPECT_EQ(sample.sparse[0][1][4].item<float>(), 10.0F);
  EXPECT_EQ(sample.sparse.count_nonzero().item<std::int64_t>(), 1);
  EXPECT_NEAR(sample.offset_s[0][1][4].item<float>(), -0.25F, 1e-6);
  EXPECT_EQ(sample.intrinsics[1].item<float>(), 441.0F);
}

TEST_F(DepthDatasetTest, RelativePosesMapPointsOfThisCameraToTheOther) {
  DepthDataset dataset(dir_);
  const DepthSample sample = dataset.get(1);
  const Eigen::Vector3d p_camera(0.5, -1, 20);
  const auto check = [&](const torch::Tensor& T, int other) {
    const Eigen::Vector3d expected = pose(other).inverse() * (pose(1) * p_camera);
    const auto p = T.matmul(torch::tensor({0.5F, -1.0F, 20.0F, 1.0F}));
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(p[axis].item<double>(), expected[axis], 1e-5);
  };
  check(sample.T_previous_camera, 0);
  check(sample.T_next_camera, 2);
  EXPECT_TRUE(sample.has_previous && sample.has_next && sample.has_right);
}

TEST_F(DepthDatasetTest, WhatIsNotThereIsMarkedAndBlack) {
  DepthDataset dataset(dir_, {{"b"}, false});
  ASSERT_EQ(dataset.size().value(), 1u);
  const DepthSample sample = dataset.get(0);
  EXPECT_FALSE(sample.has_right || sample.has_previous || sample.has_next);
  EXPECT_EQ(sample.right.abs().max().item<float>(), 0);
  EXPECT_EQ(sample.previous.abs().max().item<float>(), 0);
  EXPECT_TRUE(sample.T_next_camera.equal(torch::eye(4)));
  EXPECT_TRUE(std::isnan(sample.height_m));
}

TEST_F(DepthDatasetTest, DenseIsReadOnlyWhenAskedFor) {
  DepthDataset training(dir_);
  EXPECT_FALSE(training.get(0).dense.defined());
  DepthDataset evaluation(dir_, {{}, true});
  EXPECT_EQ(evaluation.get(0).dense.mean().item<float>(), 9);
  EXPECT_FALSE(evaluation.get(3).dense.defined());
  fs::remove_all(dir_ / "a" / "dense");
  EXPECT_NO_THROW(training.get(0));
}

TEST_F(DepthDatasetTest, FlightsAreChosenByName) {
  DepthDataset dataset(dir_, {{"b", "a"}, false});
  ASSERT_EQ(dataset.size().value(), 4u);
  EXPECT_EQ(dataset.flight(0).name, "b");
  EXPECT_EQ(dataset.flight(1).name, "a");
  EXPECT_EQ(dataset.row(3).index, 2);
  try {
    DepthDataset(dir_, {{"c"}, false});
    FAIL() << "a flight that is not there was accepted";
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), AllOf(HasSubstr("\"c\""), HasSubstr("a, b")));
  }
}

TEST_F(DepthDatasetTest, ACorruptSampleIsNamed) {
  std::ofstream(dir_ / "a" / "left" / "000001.png") << "cut off";
  EXPECT_THAT(get_error(1), HasSubstr("a/left/000001.png"));
  EXPECT_THAT(get_error(0), HasSubstr("a/left/000001.png"));  // as the next image of sample 0
  EXPECT_EQ(get_error(3), "");
  cv::imwrite((dir_ / "a" / "left" / "000001.png").string(), cv::Mat::zeros(4, 4, CV_8UC3));
  EXPECT_THAT(get_error(1), HasSubstr("4x4"));
}

TEST(TensorConversion, DepthRoundTripsAndGreyBecomesThreeChannels) {
  cv::Mat depth(3, 5, CV_32FC1);
  cv::randu(depth, 0, 100);
  EXPECT_EQ(cv::norm(tensor_to_depth(depth_to_tensor(depth)), depth, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(tensor_to_depth(depth_to_tensor(depth)[0]), depth, cv::NORM_INF), 0);
  const torch::Tensor grey = image_to_tensor(cv::Mat(2, 2, CV_8UC1, cv::Scalar(255)));
  EXPECT_TRUE(grey.equal(torch::ones({3, 2, 2})));
  EXPECT_THROW(image_to_tensor(depth), std::invalid_argument);
}

TEST(TensorConversion, AViewIntoALargerMatIsCopiedRowByRow) {
  cv::Mat large(6, 6, CV_8UC3);
  cv::randu(large, 0, 255);
  const cv::Mat part = large({1, 2, 3, 3});
  EXPECT_TRUE(image_to_tensor(part).equal(image_to_tensor(part.clone())));
}

TEST(TensorConversion, ImagesComeBackBitForBit) {
  cv::Mat image(5, 7, CV_8UC3);
  cv::RNG random(3);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  EXPECT_EQ(cv::norm(tensor_to_image(image_to_tensor(image)), image, cv::NORM_INF), 0);
  EXPECT_THROW(tensor_to_image(torch::zeros({1, 5, 7})), std::invalid_argument);
}

}  // namespace
}  // namespace alight
