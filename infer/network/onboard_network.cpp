#include "infer/network/onboard_network.hpp"

#include <algorithm>
#include <thread>

#include "foundation/errors.hpp"
#include "models/checkpoint.hpp"
#include "models/device.hpp"
#include "models/fold_batch_norm.hpp"

namespace alight {
namespace {

bool processor_has_bfloat16() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512bf16") != 0;
#else
  return false;
#endif
}

torch::Dtype number_type(NetworkPrecision precision, torch::Device device) {
  switch (precision) {
    case NetworkPrecision::kFloat32:
      break;
    case NetworkPrecision::kBfloat16:
      return torch::kBFloat16;
    case NetworkPrecision::kFloat16:
      if (device.is_cuda()) return torch::kFloat16;
      throw ConfigError("network.precision: float16 needs a CUDA device; use bfloat16, float32 or auto");
    case NetworkPrecision::kAuto:
      if (device.is_cuda()) return torch::kFloat16;
      if (processor_has_bfloat16()) return torch::kBFloat16;
  }
  return torch::kFloat32;
}

}  // namespace

OnboardNetwork load_onboard_network(const std::filesystem::path& checkpoint, const NetworkConfig& config) {
  const int machine = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  at::set_num_threads(config.threads > 0 ? config.threads : machine);
  // Numbers of 1e-39 say nothing and cost a hundred times what others do.
  at::globalContext().setFlushDenormal(true);
  OnboardNetwork network;
  network.device = find_device(config.device);
  network.type = number_type(config.precision, network.device);
  network.net = load_network(checkpoint).net;
  if (network.net->config().normalization == Normalization::kBatch)
    network.net = fold_batch_norm(network.net);
  network.net->eval();
  network.decoder.emplace(network.net);
  network.decoder->to(network.device, network.type);
  network.net->to(network.device, network.type);
  for (torch::Tensor& parameter : network.net->parameters()) {
    parameter.set_requires_grad(false);
    if (parameter.dim() == 4) parameter.set_data(parameter.contiguous(torch::MemoryFormat::ChannelsLast));
  }
  return network;
}

}  // namespace alight
