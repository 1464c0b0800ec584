#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <torch/torch.h>

#include "train/data/sample_cache.hpp"

namespace alight {

/// Samples of one size stacked. Images RGB in 0..1, depths plane depth in metres with 0 = missing.
struct Batch {
  torch::Tensor left, right, previous, next;        ///< [B,3,h,w]; zeros where absent
  torch::Tensor sparse_m;                           ///< [B,1,h,w], full window
  torch::Tensor offset_s;                           ///< [B,1,h,w]
  torch::Tensor has_right, has_previous, has_next;  ///< [B] bool
  torch::Tensor T_previous_camera, T_next_camera;   ///< [B,4,4]
  torch::Tensor intrinsics_px;                      ///< [B,4] fx fy cx cy of the cut-out
  torch::Tensor baseline_m;                         ///< [B]
  torch::Tensor height_m;                           ///< [B] above take-off; NaN: unknown
  torch::Tensor down_camera;                        ///< [B,3] the world's down in camera coordinates
  std::vector<std::int64_t> indices;                ///< of the data set, for messages

  /// All tensors on `device`; images in `format`.
  Batch to(torch::Device device, torch::MemoryFormat format) const;
};

/// Position of a cut-out's top left pixel. All views of a sample are cut alike and the principal point moves
/// along, so that the geometry between them stays true.
struct CropOrigin {
  std::int64_t row = 0;
  std::int64_t column = 0;
};

/// Stacks cut-outs of height_px x width_px. @throws DataError if the samples differ in size or are smaller
Batch stack(const std::vector<std::shared_ptr<const CompactSample>>& samples,
            const std::vector<CropOrigin>& origins, std::int64_t height_px, std::int64_t width_px);

}  // namespace alight
