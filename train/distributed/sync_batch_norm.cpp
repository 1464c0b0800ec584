#include "train/distributed/sync_batch_norm.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

namespace alight {
namespace {

using torch::autograd::AutogradContext;
using torch::autograd::Variable;
using torch::autograd::variable_list;

/// Of all processes' values, a channel each; float64, as it is made of differences of large sums.
struct Statistics {
  torch::Tensor mean, variance;  // [C], the variance biased
  double count = 0;
};

/// @param x [B,C,H,W]
Statistics statistics_of_all(const torch::Tensor& x, const SumOverProcesses& sum) {
  const auto count = static_cast<double>(x.numel() / x.size(1));
  const auto [variance, mean] = torch::var_mean(x.to(torch::kFloat32), {0, 2, 3}, /*unbiased=*/false);
  const torch::Tensor m = mean.to(torch::kFloat64);
  const torch::Tensor square = variance.to(torch::kFloat64) + m * m;
  torch::Tensor sums =
      torch::cat({count * m, count * square, torch::full({1}, count, m.options())});  // [2C+1]
  sum(sums);
  const std::int64_t channels = x.size(1);
  const double total = sums[2 * channels].item<double>();
  const torch::Tensor mean_of_all = sums.narrow(0, 0, channels) / total;
  const torch::Tensor square_of_all = sums.narrow(0, channels, channels) / total;
  return {mean_of_all, (square_of_all - mean_of_all * mean_of_all).clamp_min(0), total};
}

torch::Tensor per_channel(const torch::Tensor& values) {
  return values.to(torch::kFloat32).view({1, -1, 1, 1});
}

/// What an AutogradContext can carry of a function.
struct SumHolder : torch::CustomClassHolder {
  explicit SumHolder(SumOverProcesses sum_over_processes) : sum(std::move(sum_over_processes)) {}
  SumOverProcesses sum;
};

/// y = (x - mean) / sqrt(variance + eps) * weight + bias, where mean and variance depend on the x of all processes.
class Normalize : public torch::autograd::Function<Normalize> {
 public:
  static Variable forward(AutogradContext* context, const Variable& x, const Variable& weight,
                          const Variable& bias, const Statistics& statistics, double eps,
                          const SumOverProcesses& sum) {
    const torch::Tensor mean = statistics.mean.to(torch::kFloat32);
    context->save_for_backward({x, weight, mean, (statistics.variance + eps).rsqrt()});
    context->saved_data["count"] = statistics.count;
    context->saved_data["sum"] = c10::IValue::make_capsule(c10::make_intrusive<SumHolder>(sum));
    return torch::batch_norm(x, weight, bias, mean, statistics.variance.to(torch::kFloat32),
                             /*training=*/false, /*momentum=*/0, eps, /*cudnn_enabled=*/true);
  }

  /// With z = (x - mean) / sqrt(variance + eps): dx = weight / sqrt(variance + eps) (dy - mean(dy) - z mean(dy z)).
  static variable_list backward(AutogradContext* context, const variable_list& gradients) {
    const variable_list saved = context->get_saved_variables();
    const torch::Tensor scale = per_channel(saved[3]);                                       // [1,C,1,1]
    const torch::Tensor dy = gradients[0].to(torch::kFloat32);                               // [B,C,H,W]
    const torch::Tensor z = (saved[0].to(torch::kFloat32) - per_channel(saved[2])) * scale;  // [B,C,H,W]
    const torch::Tensor d_bias = dy.sum(torch::IntArrayRef({0, 2, 3}));                      // [C]
    const torch::Tensor d_weight = (dy * z).sum(torch::IntArrayRef({0, 2, 3}));              // [C]
    torch::Tensor means = torch::cat({d_bias, d_weight}).to(torch::kFloat64);
    static_cast<SumHolder&>(*context->saved_data["sum"].toCapsule()).sum(means);
    means /= context->saved_data["count"].toDouble();
    const std::vector<torch::Tensor> mean = means.chunk(2);
    const torch::Tensor dx =
        per_channel(saved[1]) * scale * (dy - per_channel(mean[0]) - z * per_channel(mean[1]));
    return {dx.to(saved[0].scalar_type()), d_weight, d_bias, {}, {}, {}};
  }
};

void replace_in(torch::nn::SequentialImpl& sequential, const SumOverProcesses& sum) {
  auto place = sequential.begin();
  for (const auto& child : sequential.named_children()) {
    if (const auto* norm = child.value()->as<torch::nn::BatchNorm2d>()) {
      const auto replacement = std::make_shared<SyncBatchNormImpl>(*norm, sum);
      sequential.replace_module(child.key(), replacement);  // what parameters() and to() see
      *place = torch::nn::AnyModule(replacement);           // what forward() calls
    }
    ++place;
  }
}

}  // namespace

SyncBatchNormImpl::SyncBatchNormImpl(const torch::nn::BatchNorm2dImpl& norm, SumOverProcesses sum)
    : eps_(norm.options.eps()), momentum_(norm.options.momentum().value_or(0)), sum_(std::move(sum)) {
  if (!norm.options.affine() || !norm.options.track_running_stats() || !norm.options.momentum()) {
    throw std::invalid_argument("SyncBatchNorm: expected weight, bias, running statistics and a momentum");
  }
  weight_ = register_parameter("weight", norm.weight);
  bias_ = register_parameter("bias", norm.bias);
  running_mean_ = register_buffer("running_mean", norm.running_mean);
  running_var_ = register_buffer("running_var", norm.running_var);
  num_batches_tracked_ = register_buffer("num_batches_tracked", norm.num_batches_tracked);
}

torch::Tensor SyncBatchNormImpl::forward(const torch::Tensor& x) {
  if (x.dim() != 4 || x.size(1) != weight_.size(0)) {
    throw std::invalid_argument("SyncBatchNorm: expected [B,C,H,W] with as many channels as weights");
  }
  if (!is_training()) {
    return torch::batch_norm(x, weight_, bias_, running_mean_, running_var_, /*training=*/false, momentum_,
                             eps_,
                             /*cudnn_enabled=*/true);
  }
  Statistics statistics;
  {
    const torch::NoGradGuard no_grad;
    statistics = statistics_of_all(x, sum_);
    num_batches_tracked_ += 1;
    const double unbiased = statistics.count / std::max(statistics.count - 1, 1.0);
    running_mean_.lerp_(statistics.mean.to(running_mean_.dtype()), momentum_);
    running_var_.lerp_((statistics.variance * unbiased).to(running_var_.dtype()), momentum_);
  }
  return Normalize::apply(x, weight_, bias_, statistics, eps_, sum_);
}

void synchronize_batch_norms(torch::nn::Module& module, const SumOverProcesses& sum) {
  for (const auto& part : module.modules()) {
    if (auto* sequential = part->as<torch::nn::Sequential>()) replace_in(*sequential, sum);
  }
}

}  // namespace alight
