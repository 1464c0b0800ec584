#include "infer/landing/memory/elevation_grid.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "infer/landing/memory/fused_selection.hpp"
#include "infer/landing/planes/plane_fit.hpp"
#include "infer/landing/site_selector.hpp"
#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

constexpr std::int64_t kFrame_ns = 50'000'000;

Eigen::Isometry3d camera_level_at(double x_m, double y_m, double z_m) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = scenes::attitude(0, 0);
  T.translation() = Eigen::Vector3d(x_m, y_m, z_m);
  return T;
}

/// Frames over level ground at height zero, with what a test puts on it.
class ElevationGridTest : public testing::Test {
 protected:
  using Height = std::function<double(double, double)>;

  cv::Mat depth_of(const Eigen::Isometry3d& T, const Height& height) const {
    cv::Mat depth(k_.size(), CV_32FC1);
    for (int v = 0; v < depth.rows; ++v) {
      for (int u = 0; u < depth.cols; ++u) {
        const Eigen::Vector3d ground = T * (k_.ray(u, v) * T.translation().z());
        depth.at<float>(v, u) = static_cast<float>(T.translation().z() - height(ground.x(), ground.y()));
      }
    }
    return depth;
  }
  void frame(ElevationGrid& grid, const Eigen::Isometry3d& T, const Height& height, double seconds = 0.05) {
    t_ns_ += to_nanoseconds(seconds);
    const ElevationRaster raster = rasterize(depth_of(T, height), k_, T, 0.2, 60);
    grid.add(t_ns_, raster, fit_planes(raster, {}), T.translation());
  }
  /// A frame of a network: what it predicts, and what the LiDAR's points in it hit.
  void predicted(ElevationGrid& grid, const Height& shown, const cv::Mat& returns_m, double seconds = 0.05) {
    t_ns_ += to_nanoseconds(seconds);
    const Eigen::Isometry3d T = camera_level_at(0.1, 0.1, 12);
    const ElevationRaster raster = rasterize(depth_of(T, shown), k_, T, 0.2, 60);
    const LidarReturns returns = grid.returns_of(returns_m, k_, T);
    grid.add(t_ns_, raster, fit_planes(raster, {}), T.translation(), &returns);
  }

  PinholeIntrinsics k_ = scenes::camera_of(176, 176);
  Height flat_ = [](double, double) { return 0.0; };
  Height pole_ = [](double x, double y) { return std::hypot(x - 0.1, y - 0.1) < 0.06 ? 3.0 : 0.0; };
  std::int64_t t_ns_ = 0;
};

TEST_F(ElevationGridTest, MeanAndVarianceAreThoseOfTheFrames) {
  ElevationGrid grid({});
  // The whole ground must not move with it, or the frames' heights are aligned: one patch alone.
  for (const double z_m : {0.0, 0.02, 0.04, 0.02}) {
    frame(grid, camera_level_at(0, 0, 20),
          [&](double x, double y) { return std::hypot(x, y) < 1 ? z_m : 0.0; });
  }
  const ElevationCell* cell = grid.cell(0.1, 0.1);
  ASSERT_NE(cell, nullptr);
  EXPECT_EQ(cell->count, 4);
  EXPECT_NEAR(cell->mean_m, 0.02, 1e-5);
  EXPECT_NEAR(cell->variance_m2(), 0.0002, 1e-6);
  EXPECT_EQ(cell->seen_ns, t_ns_);
  EXPECT_FALSE(cell->has_obstacle());
  EXPECT_EQ(grid.cell(1000, 0), nullptr);
}

TEST_F(ElevationGridTest, APoleSeenOnceIsNotAveragedAway) {
  ElevationGrid grid({});
  frame(grid, camera_level_at(0.1, 0.1, 12), pole_);
  for (int i = 0; i < 200; ++i) frame(grid, camera_level_at(0.1, 0.1, 12), flat_);
  const ElevationCell* cell = grid.cell(0.1, 0.1);
  EXPECT_LT(cell->mean_m, 0.3);
  EXPECT_GT(cell->top_m, 2.9);
  const ElevationRaster raster = grid.raster();
  int column = 0;
  int row = 0;
  ASSERT_TRUE(raster.cell_at(0.1, 0.1, column, row));
  EXPECT_GT(raster.top_m.at<float>(row, column), 2.9);
  EXPECT_GT(fit_planes(raster, {}).residual_m.at<float>(row + 2, column), 2) << "its disc is unsafe";
}

TEST_F(ElevationGridTest, AHazardOutOfViewIsRememberedForEverAndOneInViewUntilItsTime) {
  ElevationGridConfig config;
  config.forget_after_s = 2;
  ElevationGrid grid(config);
  frame(grid, camera_level_at(0.1, 0.1, 12), pole_);
  for (int i = 0; i < 100; ++i) frame(grid, camera_level_at(15, 0, 12), flat_);  // 5 s elsewhere
  EXPECT_TRUE(grid.cell(0.1, 0.1)->has_obstacle());
  frame(grid, camera_level_at(0.1, 0.1, 12), flat_);
  EXPECT_FALSE(grid.cell(0.1, 0.1)->has_obstacle()) << "seen without it, long after";
  frame(grid, camera_level_at(0.1, 0.1, 12), pole_);
  frame(grid, camera_level_at(0.1, 0.1, 12), flat_);
  EXPECT_TRUE(grid.cell(0.1, 0.1)->has_obstacle()) << "too soon";
}

TEST_F(ElevationGridTest, WhatANetworkAloneShowsIsNeitherRememberedNorForgotten) {
  ElevationGridConfig config;
  config.forget_after_s = 2;
  ElevationGrid grid(config);
  const Eigen::Isometry3d T = camera_level_at(0.1, 0.1, 12);
  const cv::Mat none = cv::Mat::zeros(k_.size(), CV_32FC1);
  const cv::Mat on_flat = depth_of(T, flat_);
  const cv::Mat on_pole = depth_of(T, pole_);
  const auto has_obstacle = [&] { return grid.cell(0.1, 0.1)->has_obstacle(); };
  predicted(grid, pole_, none);
  EXPECT_FALSE(has_obstacle()) << "no return";
  predicted(grid, pole_, on_flat);
  EXPECT_FALSE(has_obstacle()) << "the returns are flat";
  predicted(grid, flat_, on_pole);
  EXPECT_FALSE(has_obstacle()) << "returns alone are the frame's own affair";
  predicted(grid, pole_, on_pole);
  EXPECT_TRUE(has_obstacle()) << "one sight that both agree on";
  predicted(grid, flat_, none, 3);
  EXPECT_TRUE(has_obstacle()) << "no return says that it is gone";
  predicted(grid, flat_, on_pole, 3);
  EXPECT_TRUE(has_obstacle()) << "the returns say that it is not";
  predicted(grid, flat_, on_flat, 3);
  EXPECT_FALSE(has_obstacle());
}

TEST_F(ElevationGridTest, GroundThatANetworkAloneMovesHasNotMoved) {
  ElevationGrid grid({});
  const Eigen::Isometry3d T = camera_level_at(0.1, 0.1, 12);
  const Height hill = [](double x, double y) { return std::hypot(x, y) < 2 ? 0.6 : 0.0; };
  const auto has_obstacle = [&] { return grid.cell(0.1, 0.1)->has_obstacle(); };
  for (int i = 0; i < 20; ++i) predicted(grid, flat_, depth_of(T, flat_));
  predicted(grid, hill, depth_of(T, flat_));
  EXPECT_FALSE(has_obstacle());
  predicted(grid, hill, depth_of(T, hill));
  EXPECT_TRUE(has_obstacle());
}

TEST_F(ElevationGridTest, ACarThatDrivesOntoTheGroundShowsAtOnce) {
  ElevationGrid grid({});
  for (int i = 0; i < 60; ++i) frame(grid, camera_level_at(0, 0, 20), flat_);
  const Height car = [](double x, double y) { return std::abs(x) < 0.9 && std::abs(y) < 2.2 ? 1.5 : 0.0; };
  frame(grid, camera_level_at(0, 0, 20), car);
  const ElevationRaster raster = grid.raster();
  const GroundShape shape = fit_planes(raster, {});
  for (const double x_m : {-0.5, 0.1, 0.5}) {
    for (const double y_m : {-1.9, 0.1, 1.9}) {
      int column = 0;
      int row = 0;
      ASSERT_TRUE(raster.cell_at(x_m, y_m, column, row));
      EXPECT_GT(shape.residual_m.at<float>(row, column), 1.0) << x_m << " " << y_m;
    }
  }
}

TEST_F(ElevationGridTest, NoiseMakesNoObstacles) {
  ElevationGrid grid({});
  for (int i = 0; i < 100; ++i) {
    t_ns_ += kFrame_ns;
    const Eigen::Isometry3d T = camera_level_at(0.01 * i, 0, 20);
    const cv::Mat depth = scenes::with_noise(depth_of(T, flat_), 0.02, static_cast<std::uint32_t>(i + 1));
    const ElevationRaster raster = rasterize(depth, k_, T, 0.2, 60);
    grid.add(t_ns_, raster, fit_planes(raster, {}), T.translation());
  }
  const GroundShape shape = fit_planes(grid.raster(), {});
  double residual_m = 0;
  cv::minMaxLoc(shape.residual_m, nullptr, &residual_m);
  EXPECT_LT(residual_m, 0.05);
}

TEST_F(ElevationGridTest, HeightsThatDriftAreAlignedAndHeightsThatJumpStartAnew) {
  ElevationGrid grid({});
  for (int i = 0; i < 20; ++i) {
    const double drift_m = 0.05 * i;  // the pose says that the vehicle rises; the ground goes with it
    frame(grid, camera_level_at(0, 0, 20), flat_);
    t_ns_ += kFrame_ns;
    Eigen::Isometry3d T = camera_level_at(0, 0, 20);
    const cv::Mat depth = depth_of(T, pole_);
    T.translation().z() += drift_m;
    const ElevationRaster raster = rasterize(depth, k_, T, 0.2, 60);
    grid.add(t_ns_, raster, fit_planes(raster, {}), T.translation());
    EXPECT_NEAR(grid.height_offset_m(), drift_m, 0.01);
  }
  EXPECT_NEAR(grid.cell(-1.1, -1.1)->mean_m, 0, 0.01);
  EXPECT_FALSE(grid.cell(-1.1, -1.1)->has_obstacle());
  EXPECT_EQ(grid.starts(), 0);
  frame(grid, camera_level_at(0, 0, 25), [](double, double) { return 5.0; });
  EXPECT_EQ(grid.starts(), 1);
  EXPECT_EQ(grid.cell(0.1, 0.1)->count, 1);
}

TEST_F(ElevationGridTest, TheWindowMovesWithTheVehicleAndItsMemoryDoesNotGrow) {
  ElevationGridConfig config;
  config.size_m = 20;
  ElevationGrid grid(config);
  const std::size_t bytes = grid.bytes();
  frame(grid, camera_level_at(0.1, 0.1, 12), pole_);
  frame(grid, camera_level_at(6, -5, 12), flat_);
  ASSERT_NE(grid.cell(0.1, 0.1), nullptr);
  EXPECT_TRUE(grid.cell(0.1, 0.1)->has_obstacle()) << "still inside the window";
  frame(grid, camera_level_at(-30, 30, 12), flat_);
  EXPECT_EQ(grid.cell(0.1, 0.1), nullptr);
  frame(grid, camera_level_at(4, 0, 12), flat_);
  ASSERT_NE(grid.cell(0.1, 0.1), nullptr);
  EXPECT_FALSE(grid.cell(0.1, 0.1)->has_obstacle()) << "forgotten outside the window";
  EXPECT_EQ(grid.bytes(), bytes);
}

TEST_F(ElevationGridTest, GroundWithoutLidarReturnsIsAHazard) {
  ElevationGrid grid({});
  const Eigen::Isometry3d T = camera_level_at(0, 0, 20);
  cv::Mat returns = depth_of(T, flat_);
  for (int v = 0; v < returns.rows; ++v) {
    for (int u = 0; u < returns.cols; ++u) {
      const Eigen::Vector3d p = T * (k_.ray(u, v) * 20.0);
      const bool pond = std::hypot(p.x() - 1.5, p.y()) < 1;  // its depth is known, from the image, and flat
      if (pond || (u + v) % 4 != 0) returns.at<float>(v, u) = 0;
    }
  }
  for (int i = 0; i < 20; ++i) {
    frame(grid, T, flat_);
    grid.add_returns(grid.returns_of(returns, k_, T), T);
  }
  const ElevationRaster raster = grid.raster();
  const cv::Mat hazards = grid.hazards(raster);
  const auto at = [&](double x_m, double y_m) {
    int column = 0;
    int row = 0;
    EXPECT_TRUE(raster.cell_at(x_m, y_m, column, row));
    return hazards.at<std::uint8_t>(row, column) != 0;
  };
  EXPECT_TRUE(at(1.5, 0.1));
  EXPECT_TRUE(at(1.3, 0.3));
  EXPECT_FALSE(at(-1.5, 0.1));
  EXPECT_FALSE(at(0.1, 1.5));
}

TEST_F(ElevationGridTest, RefusesOtherCellsAndGoingBackInTime) {
  ElevationGrid grid({});
  frame(grid, camera_level_at(0, 0, 20), flat_);
  const ElevationRaster coarse =
      rasterize(depth_of(camera_level_at(0, 0, 20), flat_), k_, camera_level_at(0, 0, 20), 0.5, 60);
  EXPECT_THROW(grid.add(t_ns_ + 1, coarse, fit_planes(coarse, {}), {0, 0, 20}), std::invalid_argument);
  const ElevationRaster raster =
      rasterize(depth_of(camera_level_at(0, 0, 20), flat_), k_, camera_level_at(0, 0, 20), 0.2, 60);
  EXPECT_THROW(grid.add(t_ns_ - 1, raster, fit_planes(raster, {}), {0, 0, 20}), std::invalid_argument);
}

TEST_F(ElevationGridTest, FusedSelectionKeepsAwayFromWhatTheFrameDoesNotSee) {
  const SiteSelector selector({}, k_);
  FusedSelector fused({}, PlaneJudge({}, {}, k_));
  const auto add = [&](const Eigen::Isometry3d& T, const Height& height) {
    const cv::Mat depth = depth_of(T, height);
    const SiteSelection frame = selector.select(depth, T);
    t_ns_ += kFrame_ns;
    return std::make_pair(frame, fused.update(t_ns_, depth, {}, T, frame, false));
  };
  const Eigen::Isometry3d T = camera_level_at(0.1, 0.1, 25);
  add(T, pole_);
  const auto [frame, remembered] = add(T, flat_);
  ASSERT_TRUE(frame.found());
  const Eigen::Vector2d pole(0.1, 0.1);
  EXPECT_LT((frame.largest->p_world.head<2>() - pole).norm(), frame.largest->radius_m);
  ASSERT_TRUE(remembered.largest);
  EXPECT_GT((remembered.largest->p_world.head<2>() - pole).norm(), remembered.largest->radius_m);
  // The frame's own ground, less the pole that an earlier frame saw.
  const SiteSelection seen = selector.look(depth_of(T, flat_), T);
  const SiteSelection both = selector.decide(seen, fused.grid().obstacles(seen.ground.raster), T);
  ASSERT_TRUE(both.largest);
  EXPECT_GT((both.largest->p_world.head<2>() - pole).norm(), both.largest->radius_m);
  EXPECT_EQ(cv::countNonZero(both.safe & ~frame.safe), 0);
  EXPECT_LT(cv::countNonZero(both.safe), cv::countNonZero(frame.safe));
}

TEST(ElevationGridConfig, BadValuesAreRefused) {
  EXPECT_THROW(parse_config<ElevationGridConfig>("{cell_m: 0.05, size_m: 900}", "x"), ConfigError);
  EXPECT_THROW(parse_config<ElevationGridConfig>("{cell_size: 0.2}", "x"), ConfigError);
}

}  // namespace
}  // namespace alight
