#pragma once

#include <string>

#include <torch/torch.h>

#include "foundation/binder_fwd.hpp"
#include "losses/depth_loss.hpp"
#include "losses/photometric_loss.hpp"
#include "losses/smoothness_loss.hpp"

namespace alight {

/// What the supervised terms compare with: the depth map of the full window; only the points that were fed (the
/// paper's self-supervised mode); or only those that were not, so that copying the input is no way to a small loss.
enum class LossTarget { kGroundTruth, kInput, kHeldOut };

/// The defaults are the paper's losses and weights. A term of weight 0 is not computed.
struct TrainingLossConfig {
  double depth_weight = 1;
  double ratio_weight = 1;
  double photometric_weight = 2;
  double smoothness_weight = 1;
  LossTarget target = LossTarget::kGroundTruth;
  DepthError depth_error = DepthError::kSquared;
  PhotometricLossConfig photometric;
  SmoothnessLossConfig smoothness;
};
void bind(Binder& b, TrainingLossConfig& c);

/// What the losses see of a batch. All depths are plane depths in metres, images RGB in 0..1.
struct LossInputs {
  torch::Tensor prediction_m;                       ///< [B,1,H,W], positive
  torch::Tensor ground_truth_m;                     ///< [B,1,H,W], full window, 0 = missing
  torch::Tensor input_m;                            ///< [B,1,H,W], what was fed, 0 = missing
  torch::Tensor left;                               ///< [B,3,H,W]
  torch::Tensor previous, next, right;              ///< [B,3,H,W]
  torch::Tensor has_previous, has_next, has_right;  ///< [B] bool
  torch::Tensor T_previous_camera;                  ///< [B,4,4] left camera now -> at the image before
  torch::Tensor T_next_camera;                      ///< [B,4,4]
  torch::Tensor baseline_m;                         ///< [B], the right camera lies at +x
  torch::Tensor intrinsics_px;                      ///< [B,4] fx fy cx cy
};

/// Every term before weighting, and their weighted sum; scalars. Terms of weight 0 are 0.
struct LossTerms {
  torch::Tensor depth;
  torch::Tensor ratio;
  torch::Tensor photometric;
  torch::Tensor smoothness;
  torch::Tensor total;

  /// Name of the first term that is not finite, empty if all are.
  std::string first_not_finite() const;
};

/// C = a_d C_d + a_r C_r + a_p C_p + a_s C_s (paper 3.2).
class TrainingLoss {
 public:
  explicit TrainingLoss(const TrainingLossConfig& config = {}) : config_(config) {}
  LossTerms operator()(const LossInputs& inputs) const;

 private:
  torch::Tensor photometric(const LossInputs& inputs) const;

  TrainingLossConfig config_;
};

}  // namespace alight
