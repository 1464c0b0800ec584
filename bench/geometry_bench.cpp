#include <random>
#include <vector>

#include <benchmark/benchmark.h>

#include "accuracy/scene.hpp"
#include "geometry/projection.hpp"
#include "geometry/reprojection.hpp"

namespace alight {
namespace {

void project_points_100k(benchmark::State& state) {
  const PinholeIntrinsics k = bench::paper_rig().intrinsics;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-8, 8);
  std::vector<WorldPoint> points(100'000);
  std::int64_t t_ns = 0;
  for (WorldPoint& point : points) point = {t_ns += 10'000, {place(random), place(random), -20.0}};
  Eigen::Isometry3d T_camera_world = Eigen::Isometry3d::Identity();
  T_camera_world.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  for (auto _ : state) {
    SparseDepth sparse = SparseDepth::empty(k.size());
    benchmark::DoNotOptimize(project_points(points, T_camera_world, k, 0, {}, sparse));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}
BENCHMARK(project_points_100k)->Unit(benchmark::kMillisecond);

void reproject_depth_352(benchmark::State& state) {
  const RectifiedRig rig = bench::paper_rig();
  const cv::Mat depth = bench::ground();
  for (auto _ : state) {
    benchmark::DoNotOptimize(reproject_depth(depth, rig.intrinsics, rig.T_right_camera(), rig.intrinsics));
  }
}
BENCHMARK(reproject_depth_352)->Unit(benchmark::kMillisecond);

void sample_view_352(benchmark::State& state) {
  const RectifiedRig rig = bench::paper_rig();
  const cv::Mat depth = bench::ground();
  const cv::Mat image = bench::textured(rig.intrinsics.size());
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        sample_view(image, rig.intrinsics, depth, rig.intrinsics, rig.T_right_camera().inverse()));
  }
}
BENCHMARK(sample_view_352)->Unit(benchmark::kMillisecond);

void rotate_depth_352(benchmark::State& state) {
  const cv::Mat depth = bench::ground();
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  for (auto _ : state) benchmark::DoNotOptimize(rotate_depth(depth, bench::paper_rig().intrinsics, R));
}
BENCHMARK(rotate_depth_352)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace alight
