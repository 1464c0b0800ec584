#pragma once

#include <torch/torch.h>

#include "foundation/binder_fwd.hpp"

namespace alight {

/// `adam` (Kingma and Ba 2015; the paper); `adamw`: with decoupled weight decay (Loshchilov and Hutter 2019).
enum class OptimizerKind { kAdam, kAdamW };

/// The optimiser and its step size.
struct OptimizerConfig {
  OptimizerKind kind = OptimizerKind::kAdam;
  double learning_rate = 2e-4;
  double weight_decay = 0.01;     ///< adamw only; not on biases and normalisation
  double clip_gradient_norm = 0;  ///< longer gradients are shortened to this; 0: off
  int accumulate = 1;             ///< batches whose gradients are averaged for a step
  double average_decay = 0;       ///< of the exponential moving average of the weights that flies; 0: off
};
void bind(Binder& b, OptimizerConfig& c);

/// AdamW's decay is a step of its own before Adam's, so that one optimizer and one checkpoint format serve both.
class Optimizer {
 public:
  Optimizer(torch::nn::Module& module, const OptimizerConfig& config);

  void zero_grad() { adam_.zero_grad(); }
  /// Shortens the gradient if asked to, decays, steps. @returns the gradient's norm before, 0 if nobody asked
  double step(double learning_rate);
  torch::optim::Adam& adam() { return adam_; }

 private:
  OptimizerConfig config_;
  std::vector<torch::Tensor> parameters_;
  torch::optim::Adam adam_;
};

/// Moves `average` towards `current`: average += (1 - d) (current - average) for parameters, with d = min(decay,
/// (1 + step) / (10 + step)) so that the first steps do not linger; buffers are copied.
void update_average(torch::nn::Module& average, torch::nn::Module& current, double decay, std::int64_t step);

}  // namespace alight
