#include "losses/training_loss.hpp"

#include <array>
#include <cmath>
#include <utility>

#include "foundation/config_reader.hpp"
#include "losses/ratio_loss.hpp"

namespace alight {
namespace {

/// T_right_left of rectified cameras. @param baseline_m [B] @returns [B,4,4]
torch::Tensor right_from_left(const torch::Tensor& baseline_m) {
  torch::Tensor T = torch::eye(4, baseline_m.options()).repeat({baseline_m.size(0), 1, 1});
  T.select(1, 0).select(1, 3).copy_(-baseline_m);
  return T;
}

torch::Tensor supervision(const LossInputs& inputs, LossTarget target) {
  if (target == LossTarget::kGroundTruth) return inputs.ground_truth_m;
  if (target == LossTarget::kInput) return inputs.input_m;
  return torch::where(inputs.input_m > 0, torch::zeros_like(inputs.input_m), inputs.ground_truth_m);
}

}  // namespace

void bind(Binder& b, TrainingLossConfig& c) {
  b.field("depth_weight", c.depth_weight, "weight of the supervised depth loss", at_least(0));
  b.field("ratio_weight", c.ratio_weight, "weight of the depth ratio loss", at_least(0));
  b.field("photometric_weight", c.photometric_weight, "weight of the photometric loss", at_least(0));
  b.field("smoothness_weight", c.smoothness_weight, "weight of the smoothness loss", at_least(0));
  b.choice(
      "target", c.target,
      {{"gt", LossTarget::kGroundTruth}, {"input", LossTarget::kInput}, {"held_out", LossTarget::kHeldOut}},
      "what supervises: the points of the full window, only those fed, or only those not fed");
  b.choice("depth_error", c.depth_error,
           {{"squared", DepthError::kSquared}, {"log", DepthError::kLog}, {"rmse", DepthError::kRmse}},
           "of the depth loss: metres squared (the paper), |ln(pred / gt)|, or the root of a sample's mean "
           "square");
  b.section("photometric", c.photometric, "reconstruction of the image from nearby views");
  b.section("smoothness", c.smoothness, "derivatives of the prediction");
}

std::string LossTerms::first_not_finite() const {
  const std::array<std::pair<const char*, const torch::Tensor*>, 5> terms{{{"depth", &depth},
                                                                           {"ratio", &ratio},
                                                                           {"photometric", &photometric},
                                                                           {"smoothness", &smoothness},
                                                                           {"total", &total}}};
  for (const auto& [name, term] : terms) {
    if (!std::isfinite(term->item<double>())) return name;
  }
  return {};
}

torch::Tensor TrainingLoss::photometric(const LossInputs& inputs) const {
  std::vector<PhotometricSource> sources;
  const PhotometricLossConfig& c = config_.photometric;
  if (c.use_previous) sources.push_back({inputs.previous, inputs.T_previous_camera, inputs.has_previous});
  if (c.use_next) sources.push_back({inputs.next, inputs.T_next_camera, inputs.has_next});
  if (c.use_right) sources.push_back({inputs.right, right_from_left(inputs.baseline_m), inputs.has_right});
  return photometric_loss(inputs.left, inputs.prediction_m, inputs.intrinsics_px, sources, c);
}

LossTerms TrainingLoss::operator()(const LossInputs& inputs) const {
  const torch::Tensor target = supervision(inputs, config_.target);
  const torch::Tensor none = torch::zeros({}, inputs.prediction_m.options());
  LossTerms terms{none, none, none, none, none};
  if (config_.depth_weight > 0) terms.depth = depth_loss(inputs.prediction_m, target, config_.depth_error);
  if (config_.ratio_weight > 0) terms.ratio = ratio_loss(inputs.prediction_m, target);
  if (config_.photometric_weight > 0) terms.photometric = photometric(inputs);
  if (config_.smoothness_weight > 0) {
    terms.smoothness = smoothness_loss(inputs.prediction_m, inputs.left, config_.smoothness);
  }
  terms.total = config_.depth_weight * terms.depth + config_.ratio_weight * terms.ratio +
                config_.photometric_weight * terms.photometric + config_.smoothness_weight * terms.smoothness;
  return terms;
}

}  // namespace alight
