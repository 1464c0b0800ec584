#pragma once

#include <string>

#include <torch/torch.h>

#include "foundation/binder_fwd.hpp"
#include "models/device.hpp"

namespace alight {

/// `bfloat16`: convolutions in bfloat16 by autocast; weights, losses and the optimizer stay float32.
enum class Precision { kFloat32, kBfloat16 };

/// Order of a tensor's numbers in memory. `channels_last` nearly doubles the speed of a convolution on a processor.
enum class MemoryFormat { kContiguous, kChannelsLast };

/// Where and in what form a network computes.
struct ComputeConfig {
  std::string device = "auto";  ///< auto | cpu | cuda | cuda:N
  Precision precision = Precision::kFloat32;
  MemoryFormat memory_format = MemoryFormat::kContiguous;
  int threads = 0;                 ///< of a process; 0: its share of all cores
  int distributed_timeout_s = 30;  ///< longest wait for another process
};
void bind(Binder& b, ComputeConfig& c);

/// Sets the number of LibTorch's threads. LibTorch starts with half the cores.
/// @param threads 0: the cores' share of one of `processes`
void set_threads(int threads, int processes = 1);

/// Puts the module's parameters on `device` and its convolutions' weights in `format`.
void place(torch::nn::Module& module, torch::Device device, MemoryFormat format);

/// LibTorch's name for it.
torch::MemoryFormat torch_format(MemoryFormat format);

/// While it lives, eligible operators of this thread compute in `precision`.
class PrecisionScope {
 public:
  PrecisionScope(Precision precision, torch::Device device);
  ~PrecisionScope();
  PrecisionScope(const PrecisionScope&) = delete;
  PrecisionScope& operator=(const PrecisionScope&) = delete;

 private:
  bool on_;
  torch::DeviceType device_;
};

}  // namespace alight
