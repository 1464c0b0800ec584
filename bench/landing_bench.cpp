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

void select_site_352(benchmark::State& state) {
  const SiteSelector selector({}, bench::paper_rig().intrinsics);
  const cv::Mat depth = bench::ground();
  Eigen::Matrix3d R_world_camera;
  R_world_camera << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  R_world_camera = R_world_camera * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()).toRotationMatrix();
  for (auto _ : state) benchmark::DoNotOptimize(selector.select(depth, R_world_camera));
}
BENCHMARK(select_site_352)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace alight
