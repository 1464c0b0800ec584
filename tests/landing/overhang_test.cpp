#include "infer/landing/overhang.hpp"

#include <gtest/gtest.h>

#include "tests/landing/scenes.hpp"

namespace alight {
namespace {

using scenes::camera_of;

TEST(GroundBeneath, LiesWhereTheColumnMeetsTheGround) {
  const PinholeIntrinsics k = camera_of(353, 353);
  cv::Mat depth = scenes::level_ground(k, 20);
  cv::Mat obstacle = cv::Mat::zeros(353, 353, CV_8UC1);
  depth.at<float>(76, 276) =
      10;  // (100, -100) px from the centre at half the depth: (50, -50) px on the ground
  obstacle.at<std::uint8_t>(76, 276) = 255;
  const cv::Mat beneath = ground_beneath(depth, obstacle, k, 0.5);
  EXPECT_EQ(cv::countNonZero(beneath), 9);
  EXPECT_EQ(beneath.at<std::uint8_t>(176 - 50, 176 + 50), 255);
}

TEST(GroundBeneath, FollowsSlopingGround) {
  const PinholeIntrinsics k = camera_of(353, 353);
  cv::Mat depth = scenes::plane(k, 20, 0.1, 0);
  cv::Mat obstacle = cv::Mat::zeros(353, 353, CV_8UC1);
  depth.at<float>(176, 276) = 10;
  obstacle.at<std::uint8_t>(176, 276) = 255;
  const double x_m = 100.0 / 440 * 10;
  const double u_px = 176 + 440 * x_m / (20 + 0.1 * x_m);
  const cv::Mat beneath = ground_beneath(depth, obstacle, k, 0.5);
  EXPECT_EQ(beneath.at<std::uint8_t>(176, static_cast<int>(std::lround(u_px))), 255);
}

TEST(GroundBeneath, ObstaclesOnTheGroundHaveNothingBelow) {
  const PinholeIntrinsics k = camera_of(353, 353);
  const cv::Mat depth = scenes::level_ground(k, 20);
  const cv::Mat all(353, 353, CV_8UC1, cv::Scalar(255));
  EXPECT_EQ(cv::countNonZero(ground_beneath(depth, all, k, 0.5)), 0);
  EXPECT_EQ(cv::countNonZero(ground_beneath(cv::Mat::zeros(353, 353, CV_32FC1), all, k, 0.5)), 0);
}

TEST(GroundBeneath, UnknownGroundStaysUnmarked) {
  const PinholeIntrinsics k = camera_of(353, 353);
  cv::Mat depth = cv::Mat::zeros(353, 353, CV_32FC1);
  cv::Mat obstacle = cv::Mat::zeros(353, 353, CV_8UC1);
  depth.at<float>(76, 276) = 10;
  depth.at<float>(300, 300) = 20;
  obstacle.at<std::uint8_t>(76, 276) = 255;
  EXPECT_EQ(cv::countNonZero(ground_beneath(depth, obstacle, k, 0.5)), 0);
}

}  // namespace
}  // namespace alight
