#include "sim/objects/texture.hpp"

#include <cmath>
#include <memory>

#include <opencv2/imgproc.hpp>

#include <gtest/gtest.h>

#include "tests/sim/test_worlds.hpp"

namespace alight::sim {
namespace {

std::unique_ptr<TextureBatch> batch_of(float footprint_m) {
  auto batch = std::make_unique<TextureBatch>();
  for (std::size_t i = 0; i < TextureBatch::kCapacity; ++i) {
    batch->u_m[i] = 0.37F * static_cast<float>(i) - 11.F;
    batch->v_m[i] = 5.F - 0.11F * static_cast<float>(i);
    batch->footprint_m[i] = footprint_m;
    batch->contrast[i] = 0.2F;
    batch->fine_gain[i] = 1.F;
    batch->seed[i] = 42;
  }
  return batch;
}

/// Mean absolute difference of neighbouring pixels, grey levels.
double gradient_energy(const cv::Mat& image) {
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  cv::Mat difference;
  cv::absdiff(grey.colRange(1, grey.cols), grey.colRange(0, grey.cols - 1), difference);
  return cv::mean(difference)[0];
}

TEST(Texture, DependsOnThePlaceAlone) {
  const auto all = batch_of(0.01F);
  evaluate_noise(*all, TextureBatch::kCapacity);
  const auto few = batch_of(0.01F);
  evaluate_noise(*few, 5);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(all->brightness[i], few->brightness[i]);
    EXPECT_EQ(all->mix[i], few->mix[i]);
  }
}

TEST(Texture, IsContinuous) {
  auto here = batch_of(0.01F);
  auto beside = batch_of(0.01F);
  for (float& u : beside->u_m) u += 1e-4F;
  evaluate_noise(*here, TextureBatch::kCapacity);
  evaluate_noise(*beside, TextureBatch::kCapacity);
  for (std::size_t i = 0; i < TextureBatch::kCapacity; ++i) {
    EXPECT_NEAR(here->brightness[i], beside->brightness[i], 0.02F);
  }
}

TEST(Texture, FadesWhereThePixelIsWiderThanEveryCell) {
  const auto batch = batch_of(100.F);
  evaluate_noise(*batch, TextureBatch::kCapacity);
  for (const float brightness : batch->brightness) EXPECT_EQ(brightness, 0.F);
}

TEST(Texture, EveryGroundIsVisiblyTexturedNearAndFar) {
  for (const Material material :
       {Material::kGrass, Material::kDryGrass, Material::kSoil, Material::kGravel, Material::kAsphalt,
        Material::kConcrete, Material::kPaving, Material::kRock}) {
    const World world =
        World::from_meshes({test::plane(200, 0, 0, 0)}, {test::surface_of(material)}, 60, {0.3, 0.2, 0.9});
    const Renderer renderer(world);
    for (const double height_m : {4.0, 40.0}) {
      const View view = renderer.render_camera(test::intrinsics(), test::camera_above(1, 2, height_m), false);
      EXPECT_GT(gradient_energy(view.image), 1.0) << properties(material).name << " at " << height_m << " m";
    }
  }
}

TEST(Texture, LanesLieOnTheirRoad) {
  Surface road = test::surface_of(Material::kAsphalt);
  road.width_m = 6;
  const Eigen::Vector3f beside = surface_albedo(road, 1.F, 1.5F, 0.01F, 0, 0.5F);
  const Eigen::Vector3f edge_line = surface_albedo(road, 1.F, 2.75F, 0.01F, 0, 0.5F);
  const Eigen::Vector3f dash = surface_albedo(road, 1.F, 0.F, 0.01F, 0, 0.5F);
  const Eigen::Vector3f gap = surface_albedo(road, 4.F, 0.F, 0.01F, 0, 0.5F);
  EXPECT_GT(edge_line.x(), 4 * beside.x());
  EXPECT_GT(dash.x(), 4 * beside.x());
  EXPECT_FLOAT_EQ(gap.x(), beside.x());
}

}  // namespace
}  // namespace alight::sim
