#pragma once

#include <functional>

#include <torch/torch.h>

namespace alight {

/// Replaces a tensor by its sum over all processes.
using SumOverProcesses = std::function<void(torch::Tensor&)>;

/// torch::nn::BatchNorm2d that sees the batches of all processes as one (Ioffe and Szegedy 2015 over the whole batch).
/// The same parameters and buffers under the same names; all processes end with the same running statistics. The
/// gradients of weight and bias are of this process's samples alone, as every other layer's.
class SyncBatchNormImpl : public torch::nn::Module {
 public:
  /// Takes over options and tensors of `norm`. @throws std::invalid_argument if it lacks one of them
  SyncBatchNormImpl(const torch::nn::BatchNorm2dImpl& norm, SumOverProcesses sum);

  /// [B,C,H,W] -> [B,C,H,W]; in eval mode it talks to nobody
  torch::Tensor forward(const torch::Tensor& x);

 private:
  double eps_, momentum_;
  torch::Tensor weight_, bias_;                                     // [C]
  torch::Tensor running_mean_, running_var_, num_batches_tracked_;  // [C], [C], []
  SumOverProcesses sum_;
};

/// Replaces every BatchNorm2d that lies in a Sequential of the module, before an optimizer knows its parameters.
void synchronize_batch_norms(torch::nn::Module& module, const SumOverProcesses& sum);

}  // namespace alight
