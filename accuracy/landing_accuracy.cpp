#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "accuracy/landing_rules.hpp"
#include "accuracy/safe_mask_score.hpp"
#include "accuracy/scene.hpp"
#include "foundation/command_line.hpp"
#include "foundation/progress_bar.hpp"
#include "geometry/reprojection.hpp"
#include "infer/landing/site_selector.hpp"
#include "sim/world/world.hpp"

// How well safe ground is told from unsafe ground on perfect depth, against the simulator's truth.
namespace alight::bench {
namespace {

struct Options {
  ConfigOptions config;
  std::vector<std::string> looks = {"village", "forest", "farmland", "rocky", "urban"};
  std::vector<double> heights_m = {5, 10, 20, 30, 40};
  int seeds = 8;
  int first_seed = 9001;
  int stations = 4;
  double max_tilt_deg = 15;
  double column_m = 5.5;
};

const std::vector<std::string> kMethods = {"plane fit", "plane fit, column in view", "derivatives (paper)",
                                           "PX4-Avoidance", "HALSS circles"};

/// Scores a method collects: of every height and of every world.
struct Tally {
  std::map<double, MaskScore> by_height;
  std::vector<MaskScore> by_world;
  MaskScore all;
};

std::vector<cv::Mat> masks(const SiteSelector& planes, const SiteSelector& columns,
                           const SiteSelector& derivatives, const cv::Mat& depth_m,
                           const Eigen::Isometry3d& T, cv::Mat& level_depth_m) {
  const PinholeIntrinsics& k = planes.intrinsics();
  const SiteSelection selection = planes.select(depth_m, T);
  level_depth_m = selection.level_depth_m;
  return {selection.safe, columns.select(depth_m, T).safe, derivatives.select(depth_m, T).safe,
          px4_safe_mask(depth_m, level_depth_m, k, T, selection.R_level_camera),
          halss_safe_mask(depth_m, level_depth_m, k, T, selection.R_level_camera,
                          planes.config().rules.max_slope_deg, planes.config().rules.min_radius_m)};
}

void run_world(const sim::WorldConfig& place, const Options& options, const SiteSelector& planes,
               const SiteSelector& columns, const SiteSelector& derivatives, std::vector<Tally>& tallies) {
  const sim::World world(place);
  const sim::Renderer renderer(world);
  const sim::SurfaceTruthConfig truth_config;
  const sim::SurfaceTruth truth(renderer, truth_config);
  const PinholeIntrinsics& k = planes.intrinsics();
  const double clearance_m = planes.config().rules.vehicle_radius_m + planes.config().rules.margin_m;
  for (Tally& tally : tallies) tally.by_world.emplace_back();
  for (const double height_m : options.heights_m) {
    const auto seed = static_cast<std::uint64_t>(place.seed);
    for (const Station& s : stations(world, truth, height_m, options.stations, options.max_tilt_deg, seed)) {
      const PerfectDepth perfect = perfect_depth(renderer, k, s.T_world_camera);
      cv::Mat level_depth_m;
      const std::vector<cv::Mat> safe =
          masks(planes, columns, derivatives, perfect.depth_m, s.T_world_camera, level_depth_m);
      const Eigen::Matrix3d R_level_camera = level_rotation(s.T_world_camera.linear());
      const Eigen::Isometry3d T_world_level = level_pose(s.T_world_camera, R_level_camera);
      const cv::Mat material = level_material(perfect.material, k, R_level_camera);
      const TruthView view =
          truth_view(truth, truth_config, level_depth_m, material, k, T_world_level, clearance_m);
      for (std::size_t i = 0; i < safe.size(); ++i) {
        const MaskScore score = score_mask(safe[i], view, material);
        tallies[i].by_height[height_m].add(score);
        tallies[i].by_world.back().add(score);
        tallies[i].all.add(score);
      }
    }
  }
}

/// Standard error of a ratio over worlds (delta method: residuals of the numerator over the mean denominator).
double standard_error(const std::vector<MaskScore>& worlds, double (*part)(const MaskScore&),
                      double (*whole)(const MaskScore&)) {
  double parts = 0;
  double wholes = 0;
  for (const MaskScore& w : worlds) {
    parts += part(w);
    wholes += whole(w);
  }
  if (wholes <= 0 || worlds.size() < 2) return 0;
  double squares = 0;
  for (const MaskScore& w : worlds) squares += std::pow(part(w) - parts / wholes * whole(w), 2);
  const auto n = static_cast<double>(worlds.size());
  return std::sqrt(squares * n / (n - 1)) / wholes;
}

void print_table(const Options& options, const std::vector<Tally>& tallies) {
  std::printf("| rule | height | called safe, m2 | precision | of what is seen | off the limit | recall |\n");
  std::printf("|---|---:|---:|---:|---:|---:|---:|\n");
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    for (const double height_m : options.heights_m) {
      const MaskScore& s = tallies[i].by_height.at(height_m);
      std::printf("| %s | %g m | %.0f | %.4f | %.4f | %.4f | %.3f |\n", kMethods[i].c_str(), height_m,
                  s.called_safe_m2, s.precision(), s.precision_of_seen(), s.precision_off_limit(),
                  s.recall());
    }
    const MaskScore& s = tallies[i].all;
    const double precision_error = standard_error(
        tallies[i].by_world, [](const MaskScore& w) { return w.rightly_m2; },
        [](const MaskScore& w) { return w.called_safe_m2; });
    const double recall_error = standard_error(
        tallies[i].by_world, [](const MaskScore& w) { return w.found_m2; },
        [](const MaskScore& w) { return w.roomy_m2; });
    std::printf("| **%s** | all | %.0f | %.4f +- %.4f | **%.4f** | %.4f | **%.3f** +- %.3f |\n",
                kMethods[i].c_str(), s.called_safe_m2, s.precision(), precision_error, s.precision_of_seen(),
                s.precision_off_limit(), s.recall(), recall_error);
  }
  std::printf("\nWrongly called safe, by what the pixel shows (m2):\n");
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    std::printf("* %s:", kMethods[i].c_str());
    for (const auto& [material, area_m2] : tallies[i].all.wrong_by_material_m2)
      std::printf(" %s %.1f", material.c_str(), area_m2);
    std::printf("; at the truth's limit %.1f; outside the image %.1f\n", tallies[i].all.wrongly_at_limit_m2,
                tallies[i].all.wrongly_hidden_m2);
  }
}

int measure(const Options& options) {
  auto config = load<SiteSelectionConfig>(options.config);
  if (print_if_asked(options.config, config)) return kExitOk;
  config.method = LandingMethod::kPlaneFit;
  const PinholeIntrinsics k = paper_rig().intrinsics;
  const SiteSelector planes(config, k);
  config.plane_fit.column_m = options.column_m;
  const SiteSelector columns(config, k);
  config.method = LandingMethod::kDerivatives;
  const SiteSelector derivatives(config, k);
  std::vector<Tally> tallies(kMethods.size());
  ProgressBar progress("worlds", static_cast<std::int64_t>(options.looks.size()) * options.seeds, "worlds");
  for (const std::string& look : options.looks) {
    for (int i = 0; i < options.seeds; ++i) {
      const auto place = parse_config<sim::WorldConfig>(
          "{look: " + look + ", seed: " + std::to_string(options.first_seed + i) + "}", "--looks");
      run_world(place, options, planes, columns, derivatives, tallies);
      progress.advance();
    }
  }
  progress.finish();
  print_table(options, tallies);
  return kExitOk;
}

}  // namespace
}  // namespace alight::bench

int main(int argc, char** argv) {
  using alight::bench::Options;
  CLI::App app(
      "Holds the safe mask of site selection, and of other systems' rules, against the simulator's truth on "
      "perfect "
      "depth.",
      "alight-bench-landing");
  app.footer(
      "Examples:\n"
      "  alight-bench-landing --seeds 8\n"
      "  alight-bench-landing --looks forest --seeds 2 --set plane_fit.max_residual_m=0.08");
  Options options;
  alight::add_config_options(app, options.config);
  app.add_option("--looks", options.looks, "Kinds of places")->capture_default_str();
  app.add_option("--seeds", options.seeds, "Worlds of each kind")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--first-seed", options.first_seed, "Seed of the first world")->capture_default_str();
  app.add_option("--heights", options.heights_m, "Heights over the ground, m")->capture_default_str();
  app.add_option("--stations", options.stations, "Images of each height in each world")
      ->capture_default_str();
  app.add_option("--max-tilt", options.max_tilt_deg, "Roll and pitch are drawn up to this, degrees")
      ->check(CLI::Range(0.0, 30.0))
      ->capture_default_str();
  app.add_option("--column", options.column_m, "plane_fit.column_m of the second rule")
      ->capture_default_str();
  return alight::run_tool(app, argc, argv, [&] { return alight::bench::measure(options); });
}
