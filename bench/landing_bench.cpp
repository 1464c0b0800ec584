#include <benchmark/benchmark.h>

#include "bench/scene.hpp"
#include "infer/landing/site_selection.hpp"

namespace alight {
namespace {

void measure_terrain_352(benchmark::State& state) {
  const cv::Mat depth = bench::ground();
  for (auto _ : state) benchmark::DoNotOptimize(measure_terrain(depth, bench::paper_rig().intrinsics, {}));
}
BENCHMARK(measure_terrain_352)->Unit(benchmark::kMillisecond);

void select_site(benchmark::State& state, LandingMethod method) {
  SiteSelectionConfig config;
  config.method = method;
  const SiteSelector selector(config, bench::paper_rig().intrinsics);
  const cv::Mat depth = bench::ground();
  Eigen::Isometry3d T_world_camera(Eigen::Translation3d(3, 4, 20));
  T_world_camera.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  T_world_camera.rotate(Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()));
  for (auto _ : state) benchmark::DoNotOptimize(selector.select(depth, T_world_camera));
}
void select_site_planes_352(benchmark::State& state) { select_site(state, LandingMethod::kPlaneFit); }
void select_site_derivatives_352(benchmark::State& state) { select_site(state, LandingMethod::kDerivatives); }
BENCHMARK(select_site_planes_352)->Unit(benchmark::kMillisecond);
BENCHMARK(select_site_derivatives_352)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace alight
