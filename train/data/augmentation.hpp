#pragma once

#include "foundation/binder_fwd.hpp"
#include "train/data/batch.hpp"
#include "train/data/draw_key.hpp"

namespace alight {

/// Other looks of the same flights, for learning from few. Each sample draws its own; all 0: off.
struct AugmentationConfig {
  double horizontal_flip_probability = 0;
  double vertical_flip_probability = 0;
  double quarter_turn_probability = 0;  ///< by 90, 180 or 270 degrees, alike often; square cut-outs only
  double jitter_probability = 0;        ///< of the colours
  double max_brightness = 0.2;  ///< the factor is drawn from 1 - this .. 1 + this; so for the next two
  double max_contrast = 0.2;
  double max_saturation = 0.2;
};
void bind(Binder& b, AugmentationConfig& c);

/// Flips, turns and recolours the samples of a batch; pixels are moved, never resampled, and poses, intrinsics, height
/// and attitude move along (train/data/batch_geometry.hpp). The colours of all views of a sample change by the same map,
/// so that they still match each other. Draws are those of the key and independent of sample_density's under it.
/// @returns the given tensors themselves when all is off; else new ones
/// @throws std::invalid_argument if turns are possible and the images are not square
Batch augment(const Batch& batch, const AugmentationConfig& config, const DrawKey& key);

}  // namespace alight
