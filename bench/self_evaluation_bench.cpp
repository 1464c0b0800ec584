#include <benchmark/benchmark.h>

#include "accuracy/scene.hpp"
#include "infer/depth/interpolation.hpp"
#include "infer/depth/self_evaluation.hpp"

namespace alight {
namespace {

void stereo_test_352(benchmark::State& state) {
  const RectifiedRig rig = bench::paper_rig();
  const cv::Mat image = bench::textured(rig.intrinsics.size());
  const StereoTest test(image, image, rig);
  const cv::Mat depth = bench::ground();
  for (auto _ : state) {
    const RightView view = test.reconstruct(depth);
    benchmark::DoNotOptimize(test.score(view, nullptr));
    if (state.range(0) != 0) benchmark::DoNotOptimize(test.peak(depth, view, 0.15));
  }
}
BENCHMARK(stereo_test_352)->ArgName("probe")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void interpolate_352(benchmark::State& state) {
  cv::Mat sparse = bench::ground();
  cv::Mat missing(sparse.size(), CV_8UC1);
  cv::RNG(4).fill(missing, cv::RNG::UNIFORM, 0, 256);
  sparse.setTo(0, missing > 100);
  const cv::Mat fov(sparse.size(), CV_8UC1, cv::Scalar(255));
  for (auto _ : state) benchmark::DoNotOptimize(interpolate_inside_fov(sparse, fov, {}));
}
BENCHMARK(interpolate_352)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace alight
