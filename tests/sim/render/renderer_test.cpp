#include "sim/render/renderer.hpp"

#include <cmath>

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "geometry/reprojection.hpp"
#include "tests/sim/test_worlds.hpp"

namespace alight::sim {
namespace {

using test::camera_above;
using test::intrinsics;
using test::plane;
using test::surface_of;

double grey_at(const cv::Mat& image, double u_px, double v_px) {
  const auto& bgr =
      image.at<cv::Vec3b>(static_cast<int>(std::lround(v_px)), static_cast<int>(std::lround(u_px)));
  return (bgr[0] + bgr[1] + bgr[2]) / 3.0;
}

/// Mean absolute grey difference of the right camera and its reconstruction from the left camera with a depth map.
double reconstruction_error(const cv::Mat& left, const cv::Mat& right, const cv::Mat& depth_right_m) {
  const Eigen::Isometry3d T_left_right(Eigen::Translation3d(0.08, 0, 0));
  const SampledView seen = sample_view(left, intrinsics(), depth_right_m, intrinsics(), T_left_right);
  cv::Mat difference;
  cv::absdiff(seen.image, right, difference);
  const cv::Scalar mean = cv::mean(difference, seen.valid);
  return (mean[0] + mean[1] + mean[2]) / 3;
}

TEST(Renderer, LevelPlaneHasTheCamerasHeightAsDepth) {
  const World world = World::from_meshes({plane(100, 1, 0, 0)}, {surface_of(Material::kGrass)}, 60);
  const Renderer renderer(world);
  const View view = renderer.render_camera(intrinsics(), camera_above(3, -2, 13.5), true);
  double nearest = 0;
  double farthest = 0;
  cv::minMaxLoc(view.depth_m, &nearest, &farthest);
  EXPECT_NEAR(nearest, 12.5, 1e-4);
  EXPECT_NEAR(farthest, 12.5, 1e-4);
}

TEST(Renderer, TiltedCameraSeesPlaneWhereGeometrySaysSo) {
  const World world = World::from_meshes({plane(300, 0, 0, 0)}, {surface_of(Material::kGrass)}, 60);
  const Renderer renderer(world);
  Eigen::Isometry3d T = camera_above(1, 2, 10);
  T.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.6, 0.8, 0)));
  const View view = renderer.render_camera(intrinsics(), T, true);
  for (const int v : {0, 57, 199}) {
    for (const int u : {0, 123, 319}) {
      const Eigen::Vector3d p_world =
          T * Eigen::Vector3d(intrinsics().ray(u, v) * view.depth_m.at<float>(v, u));
      EXPECT_NEAR(p_world.z(), 0, 1e-4);
    }
  }
}

TEST(Renderer, BoxStandsOutByItsHeight) {
  TriangleMesh box;
  add_box(box, place({2, 1, 0.75F}, 0), {1, 1, 0.75F}, 1, 1);
  const World world = World::from_meshes({plane(100, 0, 0, 0), box},
                                         {surface_of(Material::kGrass), surface_of(Material::kConcrete)}, 60);
  const Renderer renderer(world);
  const View view = renderer.render_camera(intrinsics(), camera_above(0, 0, 10), true);
  const auto depth_at = [&](double x_m, double y_m, double z_m) {
    const Eigen::Vector2d px = intrinsics().project({x_m, -y_m, 10 - z_m});
    return view.depth_m.at<float>(static_cast<int>(std::lround(px.y())),
                                  static_cast<int>(std::lround(px.x())));
  };
  EXPECT_NEAR(depth_at(2, 1, 1.5), 8.5, 1e-4);
  EXPECT_NEAR(depth_at(2.9, 1.9, 1.5), 8.5, 1e-4);
  EXPECT_NEAR(depth_at(-2, 1, 0), 10, 1e-4);
}

TEST(Renderer, SkyHasNoDepth) {
  const World world = World::from_meshes({plane(100, 0, 0, 0)}, {surface_of(Material::kGrass)}, 60);
  const Renderer renderer(world);
  Eigen::Isometry3d up = camera_above(0, 0, 10);
  up.rotate(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
  const View view = renderer.render_camera(intrinsics(), up, true);
  EXPECT_EQ(cv::countNonZero(view.depth_m), 0);
  EXPECT_FALSE(renderer.cast({0, 0, 10}, {0, 0, 1}).hit);
}

TEST(Renderer, ShadowOfAPoleFallsAwayFromTheSun) {
  // Sun in the east, 45 degrees high: a mast of 2 m throws a shadow of 2 m to the west.
  TriangleMesh mast;
  add_column(mast, {0, 0, 0}, {0, 0, 2}, 0.15F, 0.15F, 12, 1);
  const World world =
      World::from_meshes({plane(100, 0, 0, 0), mast},
                         {surface_of(Material::kConcrete), surface_of(Material::kWood)}, 60, {1, 0, 1});
  const Renderer renderer(world);
  const View view = renderer.render_camera(intrinsics(), camera_above(0, 3, 12), false);
  const auto grey = [&](double x_m, double y_m) {
    const Eigen::Vector2d px = intrinsics().project({x_m, -(y_m - 3), 12});
    return grey_at(view.image, px.x(), px.y());
  };
  const double lit = grey(1.2, 0);
  EXPECT_LT(grey(-1.2, 0), 0.75 * lit);
  EXPECT_LT(grey(-1.8, 0), 0.75 * lit);
  EXPECT_GT(grey(-2.4, 0), 0.85 * lit);
  EXPECT_GT(grey(-1.2, 0.5), 0.85 * lit);
}

TEST(Renderer, BothCamerasSeeTheSamePaint) {
  for (const Look look : {Look::kVillage, Look::kRocky}) {
    WorldConfig config;
    config.look = look;
    config.size_m = 80;
    const World world(config);
    const Renderer renderer(world);
    for (const double height_m : {4.0, 12.0}) {
      const Eigen::Isometry3d T = camera_above(0, 0, world.ground_height_m(0, 0) + height_m);
      const Eigen::Isometry3d T_right = T * Eigen::Translation3d(0.08, 0, 0);
      const View left = renderer.render_camera(intrinsics(), T, true);
      const View right = renderer.render_camera(intrinsics(), T_right, true);
      const double with_truth = reconstruction_error(left.image, right.image, right.depth_m);
      const double with_wrong_depth = reconstruction_error(left.image, right.image, right.depth_m * 1.3);
      EXPECT_LT(with_truth, 4.0) << to_string(look) << " at " << height_m << " m";
      EXPECT_GT(with_wrong_depth, 1.3 * with_truth) << to_string(look) << " at " << height_m << " m";
    }
  }
}

TEST(Renderer, ThreadsDoNotChangeABit) {
  WorldConfig world_config;
  world_config.look = Look::kForest;
  world_config.size_m = 60;
  const World world(world_config);
  const Eigen::Isometry3d T = camera_above(2, 3, 20);
  std::vector<View> views;
  for (const int threads : {1, 5}) {
    RendererConfig config;
    config.threads = threads;
    views.push_back(Renderer(world, config).render_camera(intrinsics(), T, true));
  }
  EXPECT_EQ(cv::norm(views[0].image, views[1].image, cv::NORM_INF), 0);
  EXPECT_EQ(cv::norm(views[0].depth_m, views[1].depth_m, cv::NORM_INF), 0);
}

TEST(Renderer, OddImageSizesAreFilled) {
  const World world = World::from_meshes({plane(100, 0, 0, 0)}, {surface_of(Material::kGrass)}, 60);
  const Renderer renderer(world);
  const PinholeIntrinsics odd{100, 100, 18, 12, 37, 25};
  const View view = renderer.render_camera(odd, camera_above(0, 0, 5), true);
  EXPECT_EQ(view.image.size(), odd.size());
  EXPECT_EQ(cv::countNonZero(view.depth_m), 37 * 25);
}

TEST(Renderer, CastReportsRangeNormalAndReflectivity) {
  const World world = World::from_meshes({plane(100, 0, 0, 0), plane(1, 2, 0, 1)},
                                         {surface_of(Material::kAsphalt), surface_of(Material::kWater)}, 60);
  const Renderer renderer(world);
  const Hit ground = renderer.cast({10, 10, 3}, {0, 3, -3});
  ASSERT_TRUE(ground.hit);
  EXPECT_NEAR(ground.range_m, 3 * std::sqrt(2.0), 1e-5);
  EXPECT_EQ(ground.material, Material::kAsphalt);
  EXPECT_NEAR(ground.normal.z(), 1, 1e-6);
  EXPECT_GT(ground.reflectivity, 0);
  const Hit water = renderer.cast({0, 0, 3}, {0, 0, -1});
  ASSERT_TRUE(water.hit);
  EXPECT_NEAR(water.range_m, 1, 1e-6);
  EXPECT_EQ(water.reflectivity, 0);
}

TEST(Renderer, ManyRaysGiveWhatEachGivesAlone) {
  WorldConfig config;
  config.look = Look::kUrban;
  config.size_m = 60;
  const World world(config);
  const Renderer renderer(world);
  std::vector<Eigen::Vector3d> origins;
  std::vector<Eigen::Vector3d> directions;
  for (int i = 0; i < 131; ++i) {
    origins.emplace_back(0.1 * i - 5, 3 - 0.07 * i, 25);
    directions.emplace_back(std::sin(i * 0.7) * 0.4, std::cos(i * 1.3) * 0.4, -1);
  }
  std::vector<Hit> hits;
  renderer.cast_many(origins, directions, hits);
  ASSERT_EQ(hits.size(), origins.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const Hit alone = renderer.cast(origins[i], directions[i]);
    EXPECT_EQ(hits[i].hit, alone.hit);
    EXPECT_EQ(hits[i].range_m, alone.range_m);
  }
  directions.pop_back();
  EXPECT_THROW(renderer.cast_many(origins, directions, hits), std::invalid_argument);
}

TEST(Renderer, RaysDoNotSlipThroughTheSeamsOfTheGround) {
  WorldConfig config;
  config.look = Look::kRocky;
  config.size_m = 60;
  const World world(config);
  const Renderer renderer(world);
  const int lines = world.terrain()->grid_size();
  std::vector<Eigen::Vector3d> origins;
  for (int row = 1; row + 1 < lines; ++row) {
    for (int column = 1; column + 1 < lines; ++column) {
      const double x_m = world.terrain()->axis_m(column);
      const double y_m = world.terrain()->axis_m(row);
      origins.emplace_back(x_m, y_m, 300);         // a vertex
      origins.emplace_back(x_m + 0.05, y_m, 300);  // an edge
    }
  }
  std::vector<Hit> hits;
  renderer.cast_many(origins, std::vector<Eigen::Vector3d>(origins.size(), -Eigen::Vector3d::UnitZ()), hits);
  std::size_t missed = 0;
  for (const Hit& hit : hits) missed += hit.hit ? 0U : 1U;
  EXPECT_EQ(missed, 0U) << "of " << hits.size();
}

}  // namespace
}  // namespace alight::sim
