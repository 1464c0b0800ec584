#include "infer/network/network_predictor.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "geometry/depth_map.hpp"
#include "models/checkpoint.hpp"
#include "tests/models/tiny_net.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {
namespace fs = std::filesystem;

const PinholeIntrinsics kCamera{88, 88, 34.5, 25.5, 70, 52};

const NetworkConfig kFloat32{"cpu", NetworkPrecision::kFloat32, 1};

RectifiedRig rig() {
  RectifiedRig rig;
  rig.intrinsics = kCamera;
  rig.baseline_m = 0.08;
  return rig;
}

class NetworkPredictor : public testing::TestWithParam<DepthKind> {
 protected:
  void SetUp() override {
    torch::manual_seed(3);
    DepthCompletionConfig config = test::tiny_config();
    config.depth_kind = GetParam();
    net_ = DepthCompletionNet(config);
    net_->eval();
    save_checkpoint(path_, net_);
  }

  DepthCompletionNet net_{nullptr};
  const test::ScratchFolder folder_;
  const fs::path path_ = folder_ / "net.pt";
};
INSTANTIATE_TEST_SUITE_P(Kinds, NetworkPredictor,
                         testing::Values(DepthKind::kPlane, DepthKind::kPerspective));

TEST_P(NetworkPredictor, IsTheNetworkWithPlaneDepthOnBothSides) {
  cv::Mat image(52, 70, CV_8UC3);
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::Mat sparse = cv::Mat::zeros(52, 70, CV_32FC1);
  for (int i = 0; i < 60; ++i)
    sparse.at<float>(i * 7 % 52, i * 11 % 70) = 10.0F + 0.1F * static_cast<float>(i);

  const auto predictor = make_network_predictor(path_, rig(), kFloat32);
  const auto encoded = predictor->encode({image});
  const cv::Mat predicted = predictor->refine(*encoded, sparse);
  ASSERT_EQ(predicted.type(), CV_32FC1);
  ASSERT_EQ(predicted.size(), image.size());

  // The same by hand.
  const torch::NoGradGuard guard;
  torch::Tensor image_tensor = torch::empty({1, 3, 52, 70});
  torch::Tensor sparse_tensor = torch::empty({1, 1, 52, 70});
  const cv::Mat input =
      GetParam() == DepthKind::kPerspective ? plane_to_perspective(sparse, kCamera) : sparse;
  for (int v = 0; v < 52; ++v) {
    for (int u = 0; u < 70; ++u) {
      for (int c = 0; c < 3; ++c) image_tensor[0][c][v][u] = image.at<cv::Vec3b>(v, u)[2 - c] / 255.0F;
      sparse_tensor[0][0][v][u] = input.at<float>(v, u);
    }
  }
  const torch::Tensor expected = net_->forward({image_tensor}, sparse_tensor);
  const cv::Mat lengths = ray_lengths(kCamera);
  for (int v = 0; v < 52; v += 5) {
    for (int u = 0; u < 70; u += 3) {
      float depth_m = expected[0][0][v][u].item<float>();
      if (GetParam() == DepthKind::kPerspective) depth_m /= lengths.at<float>(v, u);
      EXPECT_NEAR(predicted.at<float>(v, u), depth_m, 1e-4F * depth_m);
    }
  }
  EXPECT_EQ(cv::norm(predictor->refine(*encoded, sparse), predicted, cv::NORM_INF), 0)
      << "refining changes nothing";
}

TEST(NetworkPredictorPrior, HeightAttitudeAndRightImageReachTheNetwork) {
  torch::manual_seed(5);
  DepthCompletionConfig config = test::tiny_config();
  config.prior = Prior::kAltitude;
  config.stereo = true;
  const test::ScratchFolder folder;
  const fs::path path = folder / "net.pt";
  save_checkpoint(path, DepthCompletionNet(config));
  const auto predictor = make_network_predictor(path, rig(), kFloat32);
  PredictorView view{cv::Mat(52, 70, CV_8UC3)};
  cv::RNG(1).fill(view.left, cv::RNG::UNIFORM, 0, 256);
  const auto depth_m = [&] {
    return predictor->refine(*predictor->encode(view), cv::Mat::zeros(52, 70, CV_32FC1));
  };
  const auto mean_m = [&] { return cv::mean(depth_m())[0]; };
  const double unknown_m = mean_m();
  view.down_camera = Eigen::Vector3d::UnitZ();
  view.height_m = 4;
  const cv::Mat low = depth_m();
  EXPECT_LT(cv::mean(low)[0], 0.5 * unknown_m) << "an untrained network starts near its prior";
  view.left.copyTo(view.right);
  EXPECT_GT(cv::norm(depth_m(), low, cv::NORM_INF), 0) << "the right image changes nothing";
}

TEST_P(NetworkPredictor, GreyImagesWorkAndWrongSizesAreRefused) {
  const auto predictor = make_network_predictor(path_, rig(), kFloat32);
  const auto encoded = predictor->encode({cv::Mat(52, 70, CV_8UC1, cv::Scalar(80))});
  const cv::Mat predicted = predictor->refine(*encoded, cv::Mat::zeros(52, 70, CV_32FC1));
  EXPECT_EQ(cv::countNonZero(predicted > 0), 52 * 70);
  EXPECT_THROW(predictor->encode({cv::Mat(64, 64, CV_8UC3)}), std::invalid_argument);
  EXPECT_THROW(predictor->refine(*encoded, cv::Mat::zeros(64, 64, CV_32FC1)), std::invalid_argument);
}

TEST_P(NetworkPredictor, HalfTheBitsChangeDepthByLessThanAFiftieth) {
  cv::Mat image(52, 70, CV_8UC3);
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 256);
  cv::Mat sparse = cv::Mat::zeros(52, 70, CV_32FC1);
  for (int i = 0; i < 60; ++i)
    sparse.at<float>(i * 7 % 52, i * 11 % 70) = 10.0F + 0.1F * static_cast<float>(i);
  const auto depth_m = [&](NetworkPrecision precision) {
    const auto predictor = make_network_predictor(path_, rig(), {"cpu", precision, 1});
    return predictor->refine(*predictor->encode({image}), sparse);
  };
  const cv::Mat exact = depth_m(NetworkPrecision::kFloat32);
  const cv::Mat half = depth_m(NetworkPrecision::kBfloat16);
  EXPECT_LT(cv::norm(cv::Mat(half / exact - 1), cv::NORM_INF), 0.02);
  EXPECT_GT(cv::norm(half, exact, cv::NORM_INF), 0) << "nothing was computed in bfloat16";
}

TEST_P(NetworkPredictor, Float16NeedsADeviceThatHasIt) {
  EXPECT_THROW(make_network_predictor(path_, rig(), {"cpu", NetworkPrecision::kFloat16, 1}), ConfigError);
}

TEST(NetworkPredictorFile, MissingIsADataError) {
  EXPECT_THROW(make_network_predictor("/nowhere/net.pt", rig(), kFloat32), DataError);
}

}  // namespace
}  // namespace alight
