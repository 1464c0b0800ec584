#include "infer/landing/derivatives/measure_terrain.hpp"

#include <cmath>
#include <tuple>

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include "geometry/depth_map.hpp"
#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

using scenes::camera_of;

/// slope [deg], direction of the slope in the image [deg], distance to the ground [m], image width
class TerrainOnPlanes : public testing::TestWithParam<std::tuple<double, double, double, int>> {};

TEST_P(TerrainOnPlanes, SlopeIsExactAndRoughnessZero) {
  const auto [slope_deg, direction_deg, depth_m, width_px] = GetParam();
  const PinholeIntrinsics k = camera_of(width_px, width_px - 14);
  const double gradient = std::tan(to_radians(slope_deg));
  const cv::Mat depth = scenes::plane(k, depth_m, gradient * std::cos(to_radians(direction_deg)),
                                      gradient * std::sin(to_radians(direction_deg)));
  const Terrain terrain = measure_terrain(depth, k, {});
  double min_slope = 0;
  double max_slope = 0;
  double max_roughness = 0;
  cv::minMaxLoc(terrain.slope_rad, &min_slope, &max_slope, nullptr, nullptr, terrain.known);
  cv::minMaxLoc(terrain.roughness_rad, nullptr, &max_roughness, nullptr, nullptr, terrain.known);
  EXPECT_GT(cv::countNonZero(terrain.known), 1000);
  EXPECT_NEAR(to_degrees(min_slope), slope_deg, 0.02);
  EXPECT_NEAR(to_degrees(max_slope), slope_deg, 0.02);
  EXPECT_LT(to_degrees(max_roughness), 0.04);
}

INSTANTIATE_TEST_SUITE_P(Slopes, TerrainOnPlanes,
                         testing::Combine(testing::Values(0.0, 5.0, 9.0, 11.0, 20.0, 45.0),
                                          testing::Values(0.0, 37.0, 90.0, 205.0), testing::Values(8.0, 30.0),
                                          testing::Values(352, 201)));

/// Slope and roughness by their definitions, pixel by pixel, on ground that is anything but plane.
TEST(Terrain, AnglesAreThoseOfTheirDefinition) {
  const PinholeIntrinsics k = camera_of(97, 83);
  const cv::Mat depth = scenes::with_noise(scenes::plane(k, 12, 0.2, -0.3), 0.3, 5);
  DerivativesConfig config;
  config.smoothing_px = 1;
  const Terrain terrain = measure_terrain(depth, k, config);
  const auto point = [&](int u, int v) {
    return Eigen::Vector3d(k.ray(u, v) * static_cast<double>(depth.at<float>(v, u)));
  };
  const auto bend_rad = [](const Eigen::Vector3d& first, const Eigen::Vector3d& second, int axis) {
    if (first[axis] <= 0 || second[axis] <= 0) return std::acos(0.0);
    return std::abs(std::atan2(second.z(), second.head<2>().norm()) -
                    std::atan2(first.z(), first.head<2>().norm()));
  };
  constexpr double kRounding_rad = 1e-5;  // depths and their inverses are single precision
  int compared = 0;
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const int step = static_cast<int>(std::round(0.5 * k.fx_px / depth.at<float>(v, u)));
      const bool known = u >= step && v >= step && u + step < depth.cols && v + step < depth.rows;
      ASSERT_EQ(terrain.known.at<std::uint8_t>(v, u) != 0, known) << u << " " << v;
      if (!known) continue;
      ++compared;
      const Eigen::Vector3d c = point(u, v);
      const Eigen::Vector3d normal =
          (point(u + step, v) - point(u - step, v)).cross(point(u, v + step) - point(u, v - step));
      EXPECT_NEAR(terrain.slope_rad.at<float>(v, u), std::atan2(normal.head<2>().norm(), normal.z()),
                  kRounding_rad);
      const double roughness = std::max(bend_rad(c - point(u - step, v), point(u + step, v) - c, 0),
                                        bend_rad(c - point(u, v - step), point(u, v + step) - c, 1));
      EXPECT_NEAR(terrain.roughness_rad.at<float>(v, u), roughness, kRounding_rad);
    }
  }
  EXPECT_GT(compared, 2000);
}

TEST(Terrain, StepIsSeenAtTheSameGroundDistanceFromEveryHeight) {
  for (const double z_m : {8.0, 15.0, 30.0, 60.0}) {
    const PinholeIntrinsics k = camera_of(353, 353);
    cv::Mat depth = scenes::level_ground(k, z_m);
    depth(cv::Rect(176, 0, 177, 353)).setTo(z_m - 0.3);
    const Terrain terrain = measure_terrain(depth, k, {});
    const cv::Mat rough = (terrain.roughness_rad > to_radians(10)) | (terrain.slope_rad > to_radians(10));
    const cv::Mat row = rough.row(176);
    std::vector<cv::Point> marked;
    cv::findNonZero(row, marked);
    ASSERT_FALSE(marked.empty()) << z_m;
    const double metre_per_px = z_m / 440;
    // The smoothing window widens the baseline by up to two and a half pixels.
    EXPECT_NEAR((176 - marked.front().x) * metre_per_px, 0.5, 3 * metre_per_px) << z_m;
    EXPECT_NEAR((marked.back().x - 176) * metre_per_px, 0.5, 3 * metre_per_px) << z_m;
    EXPECT_EQ(static_cast<int>(marked.size()), marked.back().x - marked.front().x + 1) << "gap at " << z_m;
  }
}

TEST(Terrain, SmallestStepSeenIsTheDocumentedOne) {
  const PinholeIntrinsics k = camera_of(201, 201);
  const auto roughest_deg = [&](double step_m) {
    cv::Mat depth = scenes::level_ground(k, 15);
    depth(cv::Rect(100, 0, 101, 201)).setTo(15 - step_m);
    double max = 0;
    const Terrain terrain = measure_terrain(depth, k, {});
    cv::minMaxLoc(terrain.roughness_rad, nullptr, &max);
    return to_degrees(max);
  };
  const double limit_m = 0.5 * std::tan(to_radians(10));
  EXPECT_LT(roughest_deg(limit_m * 0.9), 10);
  EXPECT_GT(roughest_deg(limit_m * 1.1), 10);
}

TEST(Terrain, NoiseOfTheLidarStaysFarBelowTheLimits) {
  for (const double z_m : {8.0, 15.0, 30.0}) {
    const PinholeIntrinsics k = camera_of(352, 352);
    const Terrain terrain = measure_terrain(scenes::with_noise(scenes::level_ground(k, z_m), 0.02, 7), k, {});
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(terrain.roughness_rad, mean, deviation, terrain.known);
    EXPECT_LT(to_degrees(mean[0] + 5 * deviation[0]), 10) << z_m;
  }
}

TEST(Terrain, UnknownSpreadsToWhateverNeedsIt) {
  const PinholeIntrinsics k = camera_of(101, 101);
  const double z_m = 22.0;  // baseline 10 px
  cv::Mat depth = scenes::level_ground(k, z_m);
  depth.at<float>(50, 50) = 0;
  const Terrain terrain = measure_terrain(depth, k, {});
  for (const int offset : {0, 2, 8, 10, 12}) {
    EXPECT_EQ(terrain.known.at<std::uint8_t>(50, 50 + offset), 0) << offset;
    EXPECT_EQ(terrain.known.at<std::uint8_t>(50 - offset, 50), 0) << offset;
  }
  for (const int offset : {3, 7, 13})
    EXPECT_EQ(terrain.known.at<std::uint8_t>(50, 50 + offset), 255) << offset;
  EXPECT_EQ(terrain.known.at<std::uint8_t>(50, 11), 0);  // its baseline touches the smoothing's border
  EXPECT_EQ(terrain.known.at<std::uint8_t>(50, 12), 255);
}

TEST(Terrain, NothingKnownAndTinyImages) {
  const PinholeIntrinsics k = camera_of(31, 17);
  EXPECT_EQ(cv::countNonZero(measure_terrain(cv::Mat::zeros(17, 31, CV_32FC1), k, {}).known), 0);
  const PinholeIntrinsics one = camera_of(1, 1);
  EXPECT_EQ(cv::countNonZero(measure_terrain(cv::Mat::ones(1, 1, CV_32FC1), one, {}).known), 0);
  EXPECT_THROW(measure_terrain(cv::Mat::zeros(17, 31, CV_64FC1), k, {}), std::invalid_argument);
  EXPECT_THROW(measure_terrain(cv::Mat::zeros(31, 17, CV_32FC1), k, {}), std::invalid_argument);
}

TEST(Terrain, WallIsVertical) {
  const PinholeIntrinsics k = camera_of(352, 352);
  cv::Mat depth = scenes::level_ground(k, 30);
  depth(cv::Rect(300, 0, 52, 352)).setTo(10);  // far from the axis the wall folds the ground over
  const Terrain terrain = measure_terrain(depth, k, {});
  EXPECT_GT(to_degrees(terrain.slope_rad.at<float>(176, 299)), 60);
  EXPECT_GT(to_degrees(terrain.roughness_rad.at<float>(176, 299)), 10);
}

}  // namespace
}  // namespace alight
