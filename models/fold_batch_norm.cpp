#include "models/fold_batch_norm.hpp"

#include <stdexcept>
#include <string>

namespace alight {
namespace {

using Modules = torch::OrderedDict<std::string, std::shared_ptr<torch::nn::Module>>;

/// "image_encoder.stem.conv" -> "image_encoder.stem.norm"
std::string norm_of(const std::string& conv) { return conv.substr(0, conv.rfind('.') + 1) + "norm"; }

/// y = (conv(x) - mean) / sqrt(variance + eps) * weight + bias, as one convolution.
void fold(const torch::nn::Conv2dImpl& conv, const torch::nn::BatchNorm2dImpl& norm,
          torch::nn::Conv2dImpl& folded) {
  const torch::Tensor variance = norm.running_var.to(torch::kFloat64) + norm.options.eps();
  const torch::Tensor scale = norm.weight.to(torch::kFloat64) / variance.sqrt();  // [out]
  folded.weight.copy_(conv.weight * scale.view({-1, 1, 1, 1}));
  folded.bias.copy_(norm.bias - norm.running_mean * scale);
}

void copy(const torch::nn::Conv2dImpl& conv, torch::nn::Conv2dImpl& target) {
  target.weight.copy_(conv.weight);
  if (conv.bias.defined()) target.bias.copy_(conv.bias);
}

}  // namespace

DepthCompletionNet fold_batch_norm(DepthCompletionNet net) {
  DepthCompletionConfig config = net->config();
  if (config.normalization == Normalization::kGroup) {
    throw std::invalid_argument("fold_batch_norm: group normalisation cannot be folded");
  }
  config.normalization = Normalization::kNone;
  DepthCompletionNet folded(config);
  torch::NoGradGuard no_grad;
  const Modules sources = net->named_modules();
  for (const auto& item : folded->named_modules("", /*include_self=*/false)) {
    auto* target = item.value()->as<torch::nn::Conv2d>();
    if (target == nullptr) continue;
    const auto* conv = sources[item.key()]->as<torch::nn::Conv2d>();
    const auto* norm_module = sources.find(norm_of(item.key()));
    if (norm_module == nullptr) {
      copy(*conv, *target);
    } else {
      fold(*conv, *(*norm_module)->as<torch::nn::BatchNorm2d>(), *target);
    }
  }
  folded->to(net->parameters().front().device());
  folded->eval();
  return folded;
}

}  // namespace alight
