#include "train/optimizer.hpp"

#include <algorithm>

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, OptimizerConfig& c) {
  b.choice("kind", c.kind, {{"adam", OptimizerKind::kAdam}, {"adamw", OptimizerKind::kAdamW}},
           "Adam, or Adam with decoupled weight decay");
  b.field("learning_rate", c.learning_rate, "before the schedule's factor", positive());
  b.field("weight_decay", c.weight_decay, "adamw: share of a weight that decays in a step of learning rate 1",
          between(0, 1));
  b.field("clip_gradient_norm", c.clip_gradient_norm, "longer gradients are shortened to this; 0: off",
          at_least(0));
  b.field("accumulate", c.accumulate, "batches whose gradients are averaged for a step", at_least(1));
  b.field("average_decay", c.average_decay,
          "of the moving average of the weights that is kept and flies; 0: off", between(0, 0.999999));
}

Optimizer::Optimizer(torch::nn::Module& module, const OptimizerConfig& config)
    : config_(config),
      parameters_(module.parameters()),
      adam_(parameters_, torch::optim::AdamOptions(config.learning_rate)) {}

double Optimizer::step(double learning_rate) {
  double norm = 0;
  if (config_.clip_gradient_norm > 0) {
    norm = torch::nn::utils::clip_grad_norm_(parameters_, config_.clip_gradient_norm);
  }
  if (config_.kind == OptimizerKind::kAdamW) {
    const torch::NoGradGuard no_grad;
    for (torch::Tensor& parameter : parameters_) {
      if (parameter.dim() > 1) parameter.mul_(1 - learning_rate * config_.weight_decay);
    }
  }
  for (auto& group : adam_.param_groups()) group.options().set_lr(learning_rate);
  adam_.step();
  return norm;
}

void update_average(torch::nn::Module& average, torch::nn::Module& current, double decay, std::int64_t step) {
  const torch::NoGradGuard no_grad;
  const double count = static_cast<double>(step);
  const double d = std::min(decay, (1 + count) / (10 + count));
  auto slow = average.parameters();
  const auto fast = current.parameters();
  for (std::size_t i = 0; i < slow.size(); ++i) slow[i].lerp_(fast[i], 1 - d);
  auto slow_buffers = average.buffers();
  const auto fast_buffers = current.buffers();
  for (std::size_t i = 0; i < slow_buffers.size(); ++i) slow_buffers[i].copy_(fast_buffers[i]);
}

}  // namespace alight
