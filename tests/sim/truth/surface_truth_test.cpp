#include "sim/truth/surface_truth.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "tests/sim/test_worlds.hpp"

namespace alight::sim {
namespace {

using test::camera_above;
using test::intrinsics;
using test::plane;
using test::surface_of;

struct TruthPlace {
  World world;
  Renderer renderer{world};
  SurfaceTruth truth{renderer};

  explicit TruthPlace(World w) : world(std::move(w)) {}
};

World sloped_world(double slope_deg, Material material) {
  return World::from_meshes({plane(60, 0, static_cast<float>(std::tan(to_radians(slope_deg))), 0)},
                            {surface_of(material)}, 20);
}

/// Level grass with a stone, a roof and a pond on it.
World furnished_world() {
  TriangleMesh stone;
  add_box(stone, place({4, 4, 0}, 0), {0.3F, 0.3F, 0.4F}, 1, 1);
  TriangleMesh roof;
  add_box(roof, place({-5, 5, 1.5F}, 0), {2, 2, 1.5F}, 2, 2);
  TriangleMesh pond = plane(2, 0.01F, 0, 3);
  for (Eigen::Vector3f& vertex : pond.vertices) vertex += Eigen::Vector3f(-5, -5, 0);
  TriangleMesh leaf = plane(0.5F, 4, 0, 4);
  for (Eigen::Vector3f& vertex : leaf.vertices) vertex += Eigen::Vector3f(5, -5, 0);
  return World::from_meshes(
      {plane(60, 0, 0, 0), stone, roof, pond, leaf},
      {surface_of(Material::kGrass), surface_of(Material::kRock), surface_of(Material::kRoofFlat),
       surface_of(Material::kWater), surface_of(Material::kFoliage)},
      20);
}

TEST(SurfaceTruth, LevelGroundIsSafe) {
  const TruthPlace flat(sloped_world(0, Material::kGrass));
  EXPECT_TRUE(flat.truth.is_safe(0, 0));
  EXPECT_NEAR(flat.truth.elevation_m(3, 3), 0, 1e-4);
  EXPECT_FALSE(flat.truth.is_safe(50, 0));
  EXPECT_TRUE(std::isnan(flat.truth.elevation_m(50, 0)));
}

TEST(SurfaceTruth, SlopeIsMeasuredAndLimited) {
  for (const double slope_deg : {5.0, 9.0, 11.0, 15.0}) {
    const TruthPlace place(sloped_world(slope_deg, Material::kGrass));
    EXPECT_NEAR(to_degrees(place.truth.slope_rad().at<float>(50, 50)), slope_deg, 0.01);
    EXPECT_LT(place.truth.residual_m().at<float>(50, 50), 1e-3);
    EXPECT_EQ(place.truth.is_safe(0, 0), slope_deg < 10);
  }
}

TEST(SurfaceTruth, StonesRoofsWaterAndCanopiesAreUnsafe) {
  const TruthPlace place(furnished_world());
  EXPECT_FALSE(place.truth.is_safe(4, 4));
  EXPECT_FALSE(place.truth.is_safe(4.7, 4));
  EXPECT_TRUE(place.truth.is_safe(6, 4));
  EXPECT_FALSE(place.truth.is_safe(-5, 5));
  EXPECT_FALSE(place.truth.is_safe(-5, -5));
  EXPECT_FALSE(place.truth.is_safe(5, -5));
  EXPECT_TRUE(place.truth.is_safe(0, 0));
}

TEST(SurfaceTruth, ClearanceIsTheDistanceToTheNearestDanger) {
  const TruthPlace place(furnished_world());
  EXPECT_EQ(place.truth.clearance_m(4, 4), 0);
  // From the origin the nearest dangers are the roof's and the pond's corners at (3, 3), less the fitting radius.
  EXPECT_NEAR(place.truth.clearance_m(0, 0), std::hypot(3, 3) - 0.6, 0.35);
  const SafeCircle circle = place.truth.largest_safe_circle(8);
  EXPECT_NEAR(circle.radius_m, place.truth.clearance_m(circle.centre_world.x(), circle.centre_world.y()),
              1e-6);
  EXPECT_GE(circle.radius_m, place.truth.clearance_m(0, 0));
}

TEST(SurfaceTruth, MaskAgreesWithTheGroundBelowEveryPixel) {
  const TruthPlace place(furnished_world());
  const Eigen::Isometry3d T = camera_above(0, 0, 15);
  const View view = place.renderer.render_camera(intrinsics(), T, true);
  const cv::Mat mask = place.truth.safe_mask(view.depth_m, intrinsics(), T);
  const auto at = [&](double x_m, double y_m, double z_m) {
    const Eigen::Vector2d px = intrinsics().project({x_m, -y_m, 15 - z_m});
    return mask.at<std::uint8_t>(static_cast<int>(std::lround(px.y())),
                                 static_cast<int>(std::lround(px.x())));
  };
  EXPECT_EQ(at(0, 0, 0), 255);
  EXPECT_EQ(at(6, 4, 0), 255);
  EXPECT_EQ(at(4, 4, 0.4), 0);
  EXPECT_EQ(at(-5, 5, 3), 0);
  EXPECT_EQ(at(-5, -5, 0), 0);
  EXPECT_EQ(at(5, -4.6, 4), 0);
}

TEST(SurfaceTruth, GroundBesideASafeCellsSurfaceIsNotTaken) {
  const TruthPlace place(sloped_world(0, Material::kGrass));
  const Eigen::Isometry3d T = camera_above(0, 0, 15);
  const cv::Mat above(intrinsics().size(), CV_32FC1, cv::Scalar(14.5));
  EXPECT_EQ(cv::countNonZero(place.truth.safe_mask(above, intrinsics(), T)), 0);
  const cv::Mat wrong_size(10, 10, CV_32FC1, cv::Scalar(1));
  EXPECT_THROW(place.truth.safe_mask(wrong_size, intrinsics(), T), std::invalid_argument);
}

}  // namespace
}  // namespace alight::sim
