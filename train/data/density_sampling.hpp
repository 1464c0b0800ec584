#pragma once

#include <torch/torch.h>

#include "foundation/binder_fwd.hpp"
#include "train/data/draw_key.hpp"

namespace alight {

/// `share`: a random share of the points (the paper). `window`: the points of an accumulation window, as the
/// onboard loop sees them; its length is drawn log-uniformly, because the first tenths of a second matter most.
/// `mixed`: a coin decides.
enum class DensityMode { kShare, kWindow, kMixed };

/// `batch`: one draw for the whole batch (the paper). `sample`: one for each of its samples, so that batch
/// normalisation sees all densities in every step.
enum class DensityDraw { kBatch, kSample };

/// Mixed-density training (paper 3.2, "Training Strategy"; METHOD, "Mixed-density training").
struct DensitySamplingConfig {
  DensityMode mode = DensityMode::kShare;
  DensityDraw draw = DensityDraw::kBatch;
  double no_lidar_probability = 0.2;
  double min_share = 0.1;
  double max_share = 0.5;
  double window_begin_min_s = 0;  ///< relative to the image; before it is what an onboard loop has in store
  double window_begin_max_s = 0;
  double window_min_s = 0.05;
  double window_max_s = 1.0;
  double no_image_probability = 0;   ///< both cameras; of the draws with LiDAR
  double no_right_probability = 0;   ///< the right camera alone
  double no_height_probability = 0;  ///< the vehicle's height
};
void bind(Binder& b, DensitySamplingConfig& c);

/// What the network is fed.
struct NetworkInput {
  torch::Tensor image;         ///< [B,3,H,W]; zeros where the image was dropped
  torch::Tensor right;         ///< [B,3,H,W]; zeros where it was dropped
  torch::Tensor sparse_m;      ///< [B,1,H,W] metres, 0 = missing or not drawn
  torch::Tensor knows_height;  ///< [B] bool
};

/// Draws what is fed of a batch.
/// @param image, right [B,3,H,W] @param sparse_m [B,1,H,W] the full window @param offset_s [B,1,H,W] t_point - t_image
NetworkInput sample_density(const torch::Tensor& image, const torch::Tensor& right,
                            const torch::Tensor& sparse_m, const torch::Tensor& offset_s,
                            const DensitySamplingConfig& config, const DrawKey& key);

/// Keeps every point with probability `share`; all at 1, none at 0. @param share [B,1,1,1] or scalar
torch::Tensor keep_share(const torch::Tensor& sparse_m, const torch::Tensor& share,
                         torch::Generator& generator);

/// Keeps the points with begin_s <= offset < end_s. @param end_s [B,1,1,1]
torch::Tensor keep_window(const torch::Tensor& sparse_m, const torch::Tensor& offset_s, double begin_s,
                          const torch::Tensor& end_s);

}  // namespace alight
