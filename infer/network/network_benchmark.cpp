#include "infer/network/network_benchmark.hpp"

#include <fstream>
#include <functional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "foundation/errors.hpp"
#include "infer/network/network_predictor.hpp"
#include "infer/network/onboard_network.hpp"
#include "models/network_summary.hpp"

namespace alight {
namespace {

constexpr int kUntimedRuns = 3;
constexpr double kPointShare = 0.05;  // of the pixels, what 0.1 s of a Livox Mid-40 brings

using Tensors = std::vector<torch::Tensor>;

void dump_tensor(const std::filesystem::path& path, const torch::Tensor& x) {
  const torch::Tensor values = x.to(torch::kCPU, torch::kFloat32).contiguous();
  std::ofstream stream(path, std::ios::binary);
  stream.write(static_cast<const char*>(values.data_ptr()), static_cast<std::streamsize>(values.nbytes()));
  if (!stream.flush())
    throw DataError(path.string() + ": cannot be written; check the folder and the free space");
}

double resident_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024 * 1e-6;  // Linux counts kilobytes of 1024
}

/// Random images and points over level ground: as the predictor takes them, and what it makes of them for the learned
/// part.
struct BenchmarkInputs {
  PredictorView view;
  torch::Tensor sparse;
  cv::Mat sparse_m;  // of sparse
  torch::Tensor image_input;
  torch::Tensor depth_input;
};

BenchmarkInputs benchmark_inputs(OnboardNetwork& network, const RectifiedRig& rig) {
  constexpr double kHeight_m = 20;
  const PinholeIntrinsics& k = rig.intrinsics;
  BenchmarkInputs in;
  in.view.left = in.view.right = cv::Mat(k.size(), CV_8UC3);
  cv::RNG(1).fill(in.view.left, cv::RNG::UNIFORM, 0, 256);
  in.view.height_m = kHeight_m;
  in.view.down_camera = Eigen::Vector3d::UnitZ();
  torch::manual_seed(1);
  const torch::Tensor like = torch::rand({1, 1, k.height_px, k.width_px});
  in.sparse = torch::where(like < kPointShare, kHeight_m + 10 * like, torch::zeros_like(like));
  in.sparse_m = cv::Mat(k.size(), CV_32FC1, in.sparse.data_ptr<float>());
  const torch::Tensor left = torch::rand({1, 3, k.height_px, k.width_px}).to(network.device);
  const torch::Tensor prior_m = torch::full_like(like, kHeight_m).to(network.device);
  in.image_input = network.net->image_input(
      {left, left, prior_m, torch::full({1}, k.fx_px * rig.baseline_m, network.device)});
  in.depth_input = network.net->depth_input(in.sparse.to(network.device), prior_m);
  return in;
}

/// A 3x3 convolution as the network's first level has many: what can be reached on this computer.
class BenchmarkConvolution {
 public:
  explicit BenchmarkConvolution(OnboardNetwork& network)
      : x_(network.prepare(torch::randn({1, kChannels, kSide_px, kSide_px}))),
        weight_(network.prepare(torch::randn({kChannels, kChannels, 3, 3}))) {}

  void run() const {
    torch::conv2d(x_, weight_, {}, 1, 1).flatten()[0].to(torch::kCPU, torch::kFloat32).item<float>();
  }
  static constexpr double gflop() { return 2e-9 * kChannels * kChannels * 9 * kSide_px * kSide_px; }

 private:
  static constexpr std::int64_t kChannels = 64;
  static constexpr std::int64_t kSide_px = 88;
  torch::Tensor x_;
  torch::Tensor weight_;
};

using Passes = std::vector<std::pair<const char*, std::function<void()>>>;

StageStatistics time_alternately(const Passes& passes, int runs) {
  StageStatistics stages;
  for (int run = -kUntimedRuns; run < runs; ++run) {
    StageTimes times_ms;
    for (const auto& [name, pass] : passes) {
      const StageTimer timer(times_ms, name);
      pass();
    }
    if (run >= 0) stages.add(times_ms);
  }
  return stages;
}

}  // namespace

NetworkBenchmark benchmark_network(const std::filesystem::path& checkpoint, const PinholeIntrinsics& k,
                                   double baseline_m, const NetworkConfig& config, int runs,
                                   const std::optional<std::filesystem::path>& dump) {
  RectifiedRig rig;
  rig.intrinsics = k;
  rig.baseline_m = baseline_m;
  const auto predictor = make_network_predictor(checkpoint, rig, config);
  OnboardNetwork network = load_onboard_network(checkpoint, config);
  DepthCompletionNet net = network.net;
  const torch::InferenceMode guard;
  const BenchmarkInputs in = benchmark_inputs(network, rig);
  const BenchmarkConvolution convolution(network);

  const auto encoded = predictor->encode(in.view);
  const auto image_part = [&] {
    return network.decoder->image_part(
        feature_pyramid(in.image_input, net->image_features(network.prepare(in.image_input))));
  };
  const Tensors known_part = image_part();
  torch::Tensor depth_m;
  const auto refine = [&](const Tensors& part) {
    const Tensors pyramid =
        feature_pyramid(in.depth_input, net->depth_features(network.prepare(in.depth_input)));
    depth_m = network.decoder->decode(part, pyramid).to(torch::kCPU, torch::kFloat32);
  };
  NetworkBenchmark result;
  result.stages =
      time_alternately({{"full pass", [&] { predictor->refine(*predictor->encode(in.view), in.sparse_m); }},
                        {"refinement", [&] { predictor->refine(*encoded, in.sparse_m); }},
                        {"learned full pass", [&] { refine(image_part()); }},
                        {"learned refinement", [&] { refine(known_part); }},
                        {"convolution", [&] { convolution.run(); }}},
                       runs);
  for (const LayerCost& layer : measure_layers(DepthCompletionNet(net->config()), k.height_px, k.width_px)) {
    result.gflop += layer.gflop;
    if (layer.name.rfind("image_encoder", 0) != 0) result.refinement_gflop += layer.gflop;
  }
  result.convolution_gflop_per_s =
      1e3 * BenchmarkConvolution::gflop() / result.stages.percentile_ms("convolution", 0.5);
  result.resident_memory_mb = resident_memory_mb();
  if (dump) {
    dump_tensor(*dump / "image_input.f32", in.image_input);
    dump_tensor(*dump / "depth_input.f32", in.depth_input);
    dump_tensor(*dump / "depth_m.f32", depth_m);
  }
  return result;
}

std::string NetworkBenchmark::table() const {
  const double gflop_per_s = 1e3 * gflop / stages.percentile_ms("learned full pass", 0.5);
  const std::string rest = fmt::format(
      "{:.2f} GFLOP a full pass, {:.2f} a refinement; learned part {:.0f} GFLOP/s, {:.0f} % of a "
      "convolution's {:.0f}\n"
      "resident memory {:.0f} MB\n",
      gflop, refinement_gflop, gflop_per_s, 100 * gflop_per_s / convolution_gflop_per_s,
      convolution_gflop_per_s, resident_memory_mb);
  return stages.table() + rest;
}

std::string NetworkBenchmark::json() const {
  nlohmann::json json{{"gflop", gflop},
                      {"refinement_gflop", refinement_gflop},
                      {"convolution_gflop_per_s", convolution_gflop_per_s},
                      {"resident_memory_mb", resident_memory_mb}};
  for (const char* stage : {"full pass", "refinement", "learned full pass", "learned refinement"}) {
    json[stage] = {{"median_ms", stages.percentile_ms(stage, 0.5)},
                   {"p95_ms", stages.percentile_ms(stage, 0.95)}};
  }
  return json.dump() + "\n";
}

}  // namespace alight
