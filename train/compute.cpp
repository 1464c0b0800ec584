#include "train/compute.hpp"

#include <algorithm>
#include <thread>

#include <ATen/autocast_mode.h>

#include "configs/errors.hpp"

namespace alight {

void bind(Binder& b, ComputeConfig& c) {
  b.field("device", c.device, "auto | cpu | cuda | cuda:N");
  b.choice("precision", c.precision, {{"float32", Precision::kFloat32}, {"bfloat16", Precision::kBfloat16}},
           "of the convolutions; weights and losses are float32");
  b.choice("memory_format", c.memory_format,
           {{"contiguous", MemoryFormat::kContiguous}, {"channels_last", MemoryFormat::kChannelsLast}},
           "of images and weights");
  b.field("threads", c.threads, "0: all cores; the same number gives the same weights bit for bit",
          at_least(0));
}

torch::Device find_device(const std::string& name) {
  const bool cuda = torch::cuda::is_available();
  if (name == "auto") return cuda ? torch::Device(torch::kCUDA) : torch::Device(torch::kCPU);
  if (name == "cpu") return torch::kCPU;
  if (name.rfind("cuda", 0) != 0) {
    throw ConfigError("compute.device: \"" + name + "\" is no device; expected auto, cpu, cuda or cuda:N");
  }
  if (!cuda)
    throw ConfigError("compute.device: " + name +
                      ", but this LibTorch finds no CUDA device; use cpu or auto");
  try {
    return torch::Device(name);
  } catch (const c10::Error&) {
    throw ConfigError("compute.device: \"" + name + "\" is no device; expected cuda or cuda:N");
  }
}

void set_threads(int threads) {
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  at::set_num_threads(threads > 0 ? threads : cores);
}

void place(torch::nn::Module& module, torch::Device device, MemoryFormat format) {
  module.to(device);
  if (format == MemoryFormat::kContiguous) return;
  for (torch::Tensor& parameter : module.parameters()) {
    if (parameter.dim() == 4) parameter.set_data(parameter.contiguous(torch::MemoryFormat::ChannelsLast));
  }
}

torch::MemoryFormat torch_format(MemoryFormat format) {
  return format == MemoryFormat::kContiguous ? torch::MemoryFormat::Contiguous
                                             : torch::MemoryFormat::ChannelsLast;
}

PrecisionScope::PrecisionScope(Precision precision, torch::Device device)
    : on_(precision == Precision::kBfloat16), cuda_(device.is_cuda()) {
  if (!on_) return;
  at::autocast::increment_nesting();
  if (cuda_) {
    at::autocast::set_autocast_gpu_dtype(at::kBFloat16);
    at::autocast::set_enabled(true);
  } else {
    at::autocast::set_autocast_cpu_dtype(at::kBFloat16);
    at::autocast::set_cpu_enabled(true);
  }
}

PrecisionScope::~PrecisionScope() {
  if (!on_) return;
  // Copies of weights in the lower precision are kept until the outermost scope ends.
  if (at::autocast::decrement_nesting() == 0) at::autocast::clear_cache();
  if (cuda_) {
    at::autocast::set_enabled(false);
  } else {
    at::autocast::set_cpu_enabled(false);
  }
}

}  // namespace alight
