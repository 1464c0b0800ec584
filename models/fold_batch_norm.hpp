#pragma once

#include "models/depth_completion_net.hpp"

namespace alight {

/// A copy of a trained network in eval mode that computes the same with `normalization: none`: batch normalisation is
/// a scale and a shift once training is over, and both go into the convolution before it (Jacob et al. 2018, 3.2). A
/// network without normalisation is copied.
/// @throws std::invalid_argument for group normalisation, whose scale depends on the image
DepthCompletionNet fold_batch_norm(DepthCompletionNet net);

}  // namespace alight
