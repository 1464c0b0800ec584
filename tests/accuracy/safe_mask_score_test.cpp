#include "accuracy/safe_mask_score.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "accuracy/scene.hpp"
#include "geometry/reprojection.hpp"
#include "infer/landing/site_selector.hpp"
#include "sim/world/world.hpp"
#include "tests/infer/landing/landing_scenes.hpp"

namespace alight::bench {
namespace {

constexpr double kNoise_m = 0.02;  // of the Mid-40's ranges

struct Scores {
  MaskScore planes;
  MaskScore columns;       // the air over safe ground has to be in view
  MaskScore noisy_planes;  // the same depth with kNoise_m, and the method told of it
  MaskScore derivatives;
};

/// Perfect depth over one world of every look, from 5 to 40 m, rolled and pitched up to 15 degrees.
Scores measure() {
  const PinholeIntrinsics k = paper_rig().intrinsics;
  SiteSelectionConfig config;
  config.method = LandingMethod::kPlaneFit;
  config.plane_fit.noise_m = kNoise_m;
  const SiteSelector noisy_planes(config, k);
  config.plane_fit.noise_m = 0;
  const SiteSelector planes(config, k);
  config.plane_fit.column_m = 5.5;
  const SiteSelector columns(config, k);
  config.plane_fit.column_m = 0;
  config.method = LandingMethod::kDerivatives;
  const SiteSelector derivatives(config, k);
  Scores scores;
  for (const auto look : {sim::Look::kVillage, sim::Look::kForest, sim::Look::kFarmland, sim::Look::kRocky,
                          sim::Look::kUrban}) {
    sim::WorldConfig place;
    place.look = look;
    place.seed = 9101;
    place.size_m = 120;
    const sim::World world(place);
    const sim::Renderer renderer(world);
    const sim::SurfaceTruth truth(renderer, {});
    for (const double height_m : {5.0, 20.0, 40.0}) {
      for (const Station& s : stations(world, truth, height_m, 2, 15, 9101)) {
        const PerfectDepth perfect = perfect_depth(renderer, k, s.T_world_camera);
        const SiteSelection selection = planes.select(perfect.depth_m, s.T_world_camera);
        const Eigen::Isometry3d T_world_level = level_pose(s.T_world_camera, selection.R_level_camera);
        const cv::Mat material = level_material(perfect.material, k, selection.R_level_camera);
        const TruthView view = truth_view(truth, {}, selection.level_depth_m, material, k, T_world_level,
                                          config.rules.vehicle_radius_m);
        scores.planes.add(score_mask(selection.safe, view, material));
        scores.columns.add(
            score_mask(columns.select(perfect.depth_m, s.T_world_camera).safe, view, material));
        const cv::Mat noisy_m = scenes::with_noise(perfect.depth_m, kNoise_m, 77);
        scores.noisy_planes.add(
            score_mask(noisy_planes.select(noisy_m, s.T_world_camera).safe, view, material));
        scores.derivatives.add(
            score_mask(derivatives.select(perfect.depth_m, s.T_world_camera).safe, view, material));
      }
    }
  }
  return scores;
}

const Scores& scored() {
  static const Scores scores = measure();
  return scores;
}

TEST(SafeMask, AgreesWithTheTruthWhereTheImageShowsIt) {
  const Scores& scores = scored();
  RecordProperty("precision", std::to_string(scores.planes.precision()));
  EXPECT_GT(scores.planes.called_safe_m2, 2000);
  EXPECT_GE(scores.planes.precision_of_seen(), 0.999) << scores.planes.precision();
  EXPECT_GE(scores.planes.recall(), 0.9);
  EXPECT_GT(scores.planes.precision(), scores.derivatives.precision());
}

TEST(SafeMask, AgreesWithTheWholeTruthWhereTheAirIsInView) {
  const Scores& scores = scored();
  RecordProperty("precision", std::to_string(scores.columns.precision()));
  RecordProperty("recall", std::to_string(scores.columns.recall()));
  EXPECT_GE(scores.columns.precision(), 0.999);
  EXPECT_GE(scores.columns.recall(), 0.85);
  EXPECT_LT(scores.columns.wrongly_hidden_m2, 0.3 * scores.planes.wrongly_hidden_m2);
}

TEST(SafeMask, AgreesThroughTheNoiseOfALidar) {
  const Scores& scores = scored();
  RecordProperty("precision", std::to_string(scores.noisy_planes.precision_of_seen()));
  RecordProperty("recall", std::to_string(scores.noisy_planes.recall()));
  EXPECT_GE(scores.noisy_planes.precision_of_seen(), 0.995);
  EXPECT_GE(scores.noisy_planes.recall(), 0.9);
}

}  // namespace
}  // namespace alight::bench
