#include "train/error_meter.hpp"

#include <cmath>

namespace alight {

void ErrorMeter::add(const torch::Tensor& prediction_m, const torch::Tensor& truth_m,
                     const torch::Tensor& counts) {
  const torch::Tensor error = (prediction_m - truth_m).to(torch::kFloat64);
  square_sum_m2_ += torch::where(counts, error.square(), torch::zeros_like(error)).sum().item<double>();
  pixels_ += counts.sum().item<std::int64_t>();
}

double ErrorMeter::rmse_mm() const {
  return pixels_ > 0 ? 1000 * std::sqrt(square_sum_m2_ / static_cast<double>(pixels_)) : std::nan("");
}

}  // namespace alight
