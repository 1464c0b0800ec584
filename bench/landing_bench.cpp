#include <utility>

#include <benchmark/benchmark.h>

#include "accuracy/scene.hpp"
#include "geometry/reprojection.hpp"
#include "infer/landing/derivatives/measure_terrain.hpp"
#include "infer/landing/memory/fused_selection.hpp"
#include "infer/landing/planes/ground_safety.hpp"
#include "infer/landing/planes/plane_fit.hpp"
#include "infer/landing/site_selector.hpp"

namespace alight {
namespace {

void measure_terrain_352(benchmark::State& state) {
  const cv::Mat depth = bench::ground();
  for (auto _ : state) benchmark::DoNotOptimize(measure_terrain(depth, bench::paper_rig().intrinsics, {}));
}
BENCHMARK(measure_terrain_352)->Unit(benchmark::kMillisecond);

Eigen::Isometry3d tilted_camera() {
  Eigen::Isometry3d T_world_camera(Eigen::Translation3d(3, 4, 20));
  Eigen::Matrix3d R_world_down;
  R_world_down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  T_world_camera.linear() =
      R_world_down * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()).toRotationMatrix();
  return T_world_camera;
}

void level_depth_352(benchmark::State& state) {
  const cv::Mat depth = bench::ground();
  const Eigen::Matrix3d R_level_camera = level_rotation(tilted_camera().linear());
  for (auto _ : state)
    benchmark::DoNotOptimize(rotate_depth(depth, bench::paper_rig().intrinsics, R_level_camera));
}
BENCHMARK(level_depth_352)->Unit(benchmark::kMillisecond);

void rasterize_352(benchmark::State& state) {
  const cv::Mat depth = bench::ground();
  for (auto _ : state)
    benchmark::DoNotOptimize(rasterize(depth, bench::paper_rig().intrinsics, tilted_camera(), 0.2, 60));
}
BENCHMARK(rasterize_352)->Unit(benchmark::kMillisecond);

void judge_ground_352(benchmark::State& state) {
  const ElevationRaster raster =
      rasterize(bench::ground(), bench::paper_rig().intrinsics, tilted_camera(), 0.2, 60);
  for (auto _ : state) benchmark::DoNotOptimize(judge_ground(raster, fit_planes(raster, {}), {}, {}, 0.17));
}
BENCHMARK(judge_ground_352)->Unit(benchmark::kMillisecond);

/// One frame of a hovering vehicle into the grid, its raster and planes made by site selection.
void update_grid_352(benchmark::State& state) {
  const ElevationRaster raster =
      rasterize(bench::ground(), bench::paper_rig().intrinsics, tilted_camera(), 0.2, 60);
  const GroundShape shape = fit_planes(raster, {});
  const cv::Mat points = bench::ground();  // a point in every pixel: more cannot come
  ElevationGrid grid({});
  std::int64_t t_ns = 0;
  for (auto _ : state) {
    t_ns += 50'000'000;
    const double x_m = 3 + 0.1 * static_cast<double>(t_ns / 50'000'000 % 100);  // 2 m/s: the window moves
    const LidarReturns returns = grid.returns_of(points, bench::paper_rig().intrinsics, tilted_camera());
    grid.add(t_ns, raster, shape, {x_m, 4, 20}, &returns);
    grid.add_returns(returns, tilted_camera());
  }
}
BENCHMARK(update_grid_352)->Unit(benchmark::kMillisecond);

/// The whole of the fused decision beside the frame's: grid update and judging all that is remembered.
void select_fused_352(benchmark::State& state) {
  const SiteSelector selector({}, bench::paper_rig().intrinsics);
  const cv::Mat depth = bench::ground();
  const SiteSelection frame = selector.select(depth, tilted_camera());
  FusedSelector fused({}, PlaneJudge({}, {}, bench::paper_rig().intrinsics));
  std::int64_t t_ns = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(fused.update(t_ns += 50'000'000, depth, depth, tilted_camera(), frame, true));
}
BENCHMARK(select_fused_352)->Unit(benchmark::kMillisecond);

/// A frame's decision less the remembered obstacles (site_source: both), without the grid's update.
void select_site_with_memory_352(benchmark::State& state) {
  const SiteSelector selector({}, bench::paper_rig().intrinsics);
  const cv::Mat depth = bench::ground();
  FusedSelector fused({}, PlaneJudge({}, {}, bench::paper_rig().intrinsics));
  fused.update(50'000'000, depth, depth, tilted_camera(), selector.look(depth, tilted_camera()), true);
  for (auto _ : state) {
    SiteSelection seen = selector.look(depth, tilted_camera());
    const cv::Mat remembered = fused.grid().obstacles(seen.ground.raster);
    benchmark::DoNotOptimize(selector.decide(std::move(seen), remembered, tilted_camera()));
  }
}
BENCHMARK(select_site_with_memory_352)->Unit(benchmark::kMillisecond);

void select_site(benchmark::State& state, LandingMethod method) {
  SiteSelectionConfig config;
  config.method = method;
  const SiteSelector selector(config, bench::paper_rig().intrinsics);
  const cv::Mat depth = bench::ground();
  for (auto _ : state) benchmark::DoNotOptimize(selector.select(depth, tilted_camera()));
}
void select_site_planes_352(benchmark::State& state) { select_site(state, LandingMethod::kPlaneFit); }
void select_site_derivatives_352(benchmark::State& state) { select_site(state, LandingMethod::kDerivatives); }
BENCHMARK(select_site_planes_352)->Unit(benchmark::kMillisecond);
BENCHMARK(select_site_derivatives_352)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace alight
