#include "train/compute.hpp"

#include <algorithm>
#include <thread>

#include <ATen/autocast_mode.h>
#include <torch/version.h>

#include "foundation/config_reader.hpp"

namespace alight {
namespace {

/// LibTorch's operators convert their inputs to bfloat16 on the device's kind, or no longer.
void set_autocast(torch::DeviceType device, bool on) {
#if TORCH_VERSION_MAJOR > 2 || (TORCH_VERSION_MAJOR == 2 && TORCH_VERSION_MINOR >= 4)
  if (on) at::autocast::set_autocast_dtype(device, at::kBFloat16);
  at::autocast::set_autocast_enabled(device, on);
#else
  const bool cuda = device == torch::kCUDA;
  if (on && cuda) at::autocast::set_autocast_gpu_dtype(at::kBFloat16);
  if (on && !cuda) at::autocast::set_autocast_cpu_dtype(at::kBFloat16);
  cuda ? at::autocast::set_enabled(on) : at::autocast::set_cpu_enabled(on);
#endif
}

}  // namespace

void bind(Binder& b, ComputeConfig& c) {
  b.field("device", c.device, "auto | cpu | cuda | cuda:N");
  b.choice("precision", c.precision, {{"float32", Precision::kFloat32}, {"bfloat16", Precision::kBfloat16}},
           "of the convolutions; weights and losses are float32");
  b.choice("memory_format", c.memory_format,
           {{"contiguous", MemoryFormat::kContiguous}, {"channels_last", MemoryFormat::kChannelsLast}},
           "of images and weights");
  b.field("threads", c.threads,
          "of a process; 0: its share of all cores; the same number gives the same weights bit for bit",
          at_least(0));
  b.field("distributed_timeout_s", c.distributed_timeout_s,
          "training with several processes: longest wait for another one, seconds", between(1, 3600));
}

void set_threads(int threads, int processes) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency()) / processes;
  at::set_num_threads(threads > 0 ? threads : std::max(1, cores));
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
    : on_(precision == Precision::kBfloat16), device_(device.type()) {
  if (!on_) return;
  at::autocast::increment_nesting();
  set_autocast(device_, true);
}

PrecisionScope::~PrecisionScope() {
  if (!on_) return;
  // Copies of weights in the lower precision are kept until the outermost scope ends.
  if (at::autocast::decrement_nesting() == 0) at::autocast::clear_cache();
  set_autocast(device_, false);
}

}  // namespace alight
