#include "train/benchmark.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>
#include <sys/resource.h>

#include "foundation/errors.hpp"
#include "models/network_summary.hpp"
#include "train/trainer.hpp"

namespace alight {
namespace {

constexpr int kWarmUpRuns = 2;  // memory is asked for and oneDNN's kernels are made in the first
constexpr int kLeastConvolutions = 10;

/// Times each of `runs` calls after the warm-up. @returns work a second
Spread speed(double work, int runs, const std::function<void()>& call) {
  std::vector<double> speeds;
  for (int i = -kWarmUpRuns; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    call();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    if (i >= 0) speeds.push_back(work / seconds.count());
  }
  return spread_of(speeds);
}

/// The Trainer wants a folder, though a benchmark keeps nothing.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_((std::filesystem::temp_directory_path() / "alight_benchmark_XXXXXX").string()) {
    if (mkdtemp(path_.data()) == nullptr) throw DataError(path_ + ": cannot be created");
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A graphics card works on after the call that gave it its work.
void wait_for(torch::Device device) {
  if (device.is_cuda()) torch::cuda::synchronize();
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 * 1e-6;  // Linux counts kilobytes of 1024
}

double network_gflop(const DepthCompletionConfig& model, const Batch& batch) {
  double gflop = 0;
  for (const LayerCost& layer :
       measure_layers(DepthCompletionNet(model), batch.left.size(2), batch.left.size(3)))
    gflop += layer.gflop;
  return gflop;
}

std::string row(const char* name, const Spread& s, const char* unit) {
  return fmt::format("{:34} {:>9.2f}  ({:.2f} .. {:.2f}) {}\n", name, s.median, s.min, s.max, unit);
}

std::string json_field(const char* name, const Spread& s) {
  return fmt::format("\"{}\": {{\"min\": {:.6g}, \"median\": {:.6g}, \"max\": {:.6g}}}, ", name, s.min,
                     s.median, s.max);
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  if (values.empty()) throw std::invalid_argument("spread_of: expected at least one value");
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
  return {values.front(), median, values.back()};
}

double TrainingBenchmark::convolution_share() const {
  return 3 * network_gflop * fixed_images_per_s.median / convolution_gflop_per_s.median;
}

std::string TrainingBenchmark::table() const {
  const std::string rest = fmt::format(
      "{:34} {:>9.0f}  MB\n{:34} {:>9.3f}  GFLOP an image\n{:34} {:>9.1f}  % of the convolution's speed\n",
      "most resident memory", peak_memory_mb, "network, forward", network_gflop, "step, fixed batch",
      100 * convolution_share());
  return row("steps with loading", loading_images_per_s, "images/s") +
         row("steps on a fixed batch", fixed_images_per_s, "images/s") +
         row("3x3 convolution, both directions", convolution_gflop_per_s, "GFLOP/s") + rest;
}

std::string TrainingBenchmark::json() const {
  const std::string rest =
      fmt::format("\"peak_memory_mb\": {:.6g}, \"network_gflop\": {:.6g}, \"convolution_share\": {:.6g}}}\n",
                  peak_memory_mb, network_gflop, convolution_share());
  return "{" + json_field("loading_images_per_s", loading_images_per_s) +
         json_field("fixed_images_per_s", fixed_images_per_s) +
         json_field("convolution_gflop_per_s", convolution_gflop_per_s) + rest;
}

Spread convolution_gflop_per_s(Precision precision, torch::Device device, int runs) {
  constexpr std::int64_t kBatch = 8, kChannels = 64, kSide_px = 88, kKernel = 3;
  const auto make = [&](torch::IntArrayRef shape) {
    return torch::randn(shape, device)
        .to(precision == Precision::kBfloat16 ? torch::kBFloat16 : torch::kFloat32)
        .contiguous(torch::MemoryFormat::ChannelsLast)
        .requires_grad_();
  };
  const torch::Tensor input = make({kBatch, kChannels, kSide_px, kSide_px});
  const torch::Tensor weight = make({kChannels, kChannels, kKernel, kKernel});
  const torch::Tensor slope = make({kBatch, kChannels, kSide_px, kSide_px}).detach();
  constexpr double kForward_gflop =
      2e-9 * kBatch * kChannels * kChannels * kSide_px * kSide_px * kKernel * kKernel;
  return speed(3 * kForward_gflop, runs, [&] {
    const torch::Tensor output = torch::conv2d(input, weight, {}, 1, kKernel / 2);
    const auto gradients = torch::autograd::grad({output}, {input, weight}, {slope});
    wait_for(device);
  });
}

TrainingBenchmark benchmark_training(const TrainConfig& config, SampleSource& training, int steps) {
  if (steps < 1) throw std::invalid_argument("benchmark_training: expected at least one step");
  TrainConfig c = config;
  const torch::Device device = find_device(c.compute.device);
  const int accumulate = c.optimizer.accumulate;
  const std::int64_t timed_and_not = steps + kWarmUpRuns;
  c.train.steps_per_epoch = static_cast<int>(timed_and_not) * accumulate;
  const TemporaryFolder folder;
  RunFolder run(folder.path());
  Trainer trainer(c, training, nullptr, run);
  TrainingBenchmark result;
  const double images = static_cast<double>(c.train.batch_size) * accumulate;
  BatchLoader batches = trainer.loader(1);
  Batch last;
  const auto timed_steps = [&](const std::function<Batch()>& next) {
    return speed(images, steps, [&] {
      trainer.train_step(next, 1, timed_and_not);
      wait_for(device);
    });
  };
  result.loading_images_per_s = timed_steps([&] { return last = *batches.next(); });
  result.fixed_images_per_s = timed_steps([&] { return last; });
  result.peak_memory_mb = peak_memory_mb();
  result.network_gflop = network_gflop(c.model, last);
  result.convolution_gflop_per_s =
      convolution_gflop_per_s(c.compute.precision, device, std::max(steps, kLeastConvolutions));
  return result;
}

}  // namespace alight
