#pragma once

#include <cstdint>

#include <torch/torch.h>

namespace alight {

/// Root mean square of depth errors over all pixels of all images added.
class ErrorMeter {
 public:
  /// @param prediction_m, truth_m [B,1,H,W] metres @param counts bool, same shape
  void add(const torch::Tensor& prediction_m, const torch::Tensor& truth_m, const torch::Tensor& counts);

  /// Millimetres; NaN before the first pixel.
  double rmse_mm() const;
  std::int64_t pixels() const { return pixels_; }

 private:
  double square_sum_m2_ = 0;
  std::int64_t pixels_ = 0;
};

}  // namespace alight
