#include "infer/network_benchmark.hpp"

#include <cstdio>
#include <fstream>
#include <functional>
#include <vector>

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "configs/errors.hpp"
#include "infer/network_predictor.hpp"
#include "infer/onboard_network.hpp"
#include "models/network_summary.hpp"

namespace alight {
namespace {

constexpr int kWarmUpRuns = 3;
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

}  // namespace

NetworkBenchmark benchmark_network(const std::filesystem::path& checkpoint, const PinholeIntrinsics& k,
                                   double baseline_m, const NetworkConfig& config, int runs,
                                   const std::optional<std::filesystem::path>& dump) {
  NetworkBenchmark result;
  RectifiedRig rig;
  rig.intrinsics = k;
  rig.baseline_m = baseline_m;
  const auto predictor = make_network_predictor(checkpoint, rig, config);
  OnboardNetwork network = load_onboard_network(checkpoint, config);
  DepthCompletionNet net = network.net;
  const torch::InferenceMode guard;

  constexpr double kHeight_m = 20;
  PredictorView view;
  view.left = view.right = cv::Mat(k.size(), CV_8UC3);
  cv::RNG(1).fill(view.left, cv::RNG::UNIFORM, 0, 256);
  view.height_m = kHeight_m;
  view.down_camera = Eigen::Vector3d::UnitZ();
  torch::manual_seed(1);
  const torch::Tensor like = torch::rand({1, 1, k.height_px, k.width_px});
  const torch::Tensor sparse =
      torch::where(like < kPointShare, kHeight_m + 10 * like, torch::zeros_like(like));
  const cv::Mat sparse_m(k.size(), CV_32FC1, sparse.data_ptr<float>());
  const torch::Tensor prior_m = torch::full_like(like, kHeight_m);
  const torch::Tensor left = torch::rand({1, 3, k.height_px, k.width_px});
  const torch::Tensor image_input =
      net->image_input({left.to(network.device), left.to(network.device), prior_m.to(network.device),
                        torch::full({1}, k.fx_px * baseline_m, network.device)});
  const torch::Tensor depth_input = net->depth_input(sparse.to(network.device), prior_m.to(network.device));

  constexpr std::int64_t kChannels = 64, kSide_px = 88;
  const torch::Tensor x = network.prepare(torch::randn({1, kChannels, kSide_px, kSide_px}));
  const torch::Tensor weight = network.prepare(torch::randn({kChannels, kChannels, 3, 3}));
  constexpr double kConvolution_gflop = 2e-9 * kChannels * kChannels * 9 * kSide_px * kSide_px;

  const auto encoded = predictor->encode(view);
  const auto image_part = [&] {
    return network.decoder->image_part(
        feature_pyramid(image_input, net->image_features(network.prepare(image_input))));
  };
  const Tensors known_part = image_part();
  torch::Tensor depth_m;
  const auto refine = [&](const Tensors& part) {
    depth_m =
        network.decoder
            ->decode(part, feature_pyramid(depth_input, net->depth_features(network.prepare(depth_input))))
            .to(torch::kCPU, torch::kFloat32);
  };
  const std::vector<std::pair<const char*, std::function<void()>>> passes{
      {"full pass", [&] { predictor->refine(*predictor->encode(view), sparse_m); }},
      {"refinement", [&] { predictor->refine(*encoded, sparse_m); }},
      {"learned full pass", [&] { refine(image_part()); }},
      {"learned refinement", [&] { refine(known_part); }},
      {"convolution", [&] {
         torch::conv2d(x, weight, {}, 1, 1).flatten()[0].to(torch::kCPU, torch::kFloat32).item<float>();
       }}};
  for (int run = -kWarmUpRuns; run < runs; ++run) {
    StageTimes times_ms;
    for (const auto& [name, pass] : passes) {
      const StageTimer timer(times_ms, name);
      pass();
    }
    if (run >= 0) result.stages.add(times_ms);
  }
  for (const LayerCost& layer : measure_layers(DepthCompletionNet(net->config()), k.height_px, k.width_px)) {
    result.gflop += layer.gflop;
    if (layer.name.rfind("image_encoder", 0) != 0) result.refinement_gflop += layer.gflop;
  }
  result.convolution_gflop_per_s = 1e3 * kConvolution_gflop / result.stages.percentile_ms("convolution", 0.5);
  result.resident_memory_mb = resident_memory_mb();
  if (dump) {
    dump_tensor(*dump / "image_input.f32", image_input);
    dump_tensor(*dump / "depth_input.f32", depth_input);
    dump_tensor(*dump / "depth_m.f32", depth_m);
  }
  return result;
}

std::string NetworkBenchmark::table() const {
  const double gflop_per_s = 1e3 * gflop / stages.percentile_ms("learned full pass", 0.5);
  char rest[256];
  std::snprintf(rest, sizeof rest,
                "%.2f GFLOP a full pass, %.2f a refinement; learned part %.0f GFLOP/s, %.0f %% of a "
                "convolution's %.0f\n"
                "resident memory %.0f MB\n",
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
