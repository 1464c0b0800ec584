#include "losses/view_synthesis.hpp"

#include <stdexcept>

namespace alight {
namespace {

constexpr double kNearest_m = 1e-3;
// Rounding must not decide whether the outermost pixels of a view that moves along them count.
constexpr double kBorderTolerance_px = 1e-3;

void check_shapes(const torch::Tensor& source, const torch::Tensor& depth, const torch::Tensor& intrinsics,
                  const torch::Tensor& T) {
  const std::int64_t batch = depth.size(0);
  const bool images = source.dim() == 4 && depth.dim() == 4 && depth.size(1) == 1 &&
                      source.size(0) == batch && source.size(2) == depth.size(2) &&
                      source.size(3) == depth.size(3);
  if (!images || depth.size(2) < 2 || depth.size(3) < 2) {
    throw std::invalid_argument(
        "synthesise_view: expected source [B,C,H,W] and depth [B,1,H,W], at least 2x2 pixels");
  }
  if (!intrinsics.sizes().equals({batch, 4}) || !T.sizes().equals({batch, 4, 4})) {
    throw std::invalid_argument("synthesise_view: expected intrinsics [B,4] and T_source_target [B,4,4]");
  }
}

/// Pixel position -> grid_sample's -1 .. 1 between the centres of the outer pixels.
torch::Tensor normalised(const torch::Tensor& position_px, std::int64_t size_px) {
  return position_px * (2.0 / static_cast<double>(size_px - 1)) - 1.0;
}

torch::Tensor inside(const torch::Tensor& position_px, std::int64_t size_px) {
  return (position_px >= -kBorderTolerance_px) &
         (position_px <= static_cast<double>(size_px - 1) + kBorderTolerance_px);
}

}  // namespace

SynthesisedView synthesise_view(const torch::Tensor& source, const torch::Tensor& depth_target_m,
                                const torch::Tensor& intrinsics_px, const torch::Tensor& T_source_target) {
  check_shapes(source, depth_target_m, intrinsics_px, T_source_target);
  const std::int64_t height = source.size(2);
  const std::int64_t width = source.size(3);
  const auto intrinsic = [&](std::int64_t i) { return intrinsics_px.select(1, i).view({-1, 1, 1}); };
  const auto element = [&](std::int64_t row, std::int64_t column) {
    return T_source_target.select(1, row).select(1, column).view({-1, 1, 1});
  };
  const torch::Tensor z = depth_target_m.squeeze(1);  // [B,H,W]
  const torch::Tensor u = torch::arange(width, z.options()).view({1, 1, -1});
  const torch::Tensor v = torch::arange(height, z.options()).view({1, -1, 1});
  const torch::Tensor x = (u - intrinsic(2)) / intrinsic(0) * z;
  const torch::Tensor y = (v - intrinsic(3)) / intrinsic(1) * z;
  const auto coordinate = [&](std::int64_t row) {
    return element(row, 0) * x + element(row, 1) * y + element(row, 2) * z + element(row, 3);
  };
  const torch::Tensor source_z = coordinate(2);
  const torch::Tensor safe_z = source_z.clamp_min(kNearest_m);
  const torch::Tensor source_u = intrinsic(0) * coordinate(0) / safe_z + intrinsic(2);
  const torch::Tensor source_v = intrinsic(1) * coordinate(1) / safe_z + intrinsic(3);
  const torch::Tensor valid = (source_z > kNearest_m) & inside(source_u, width) & inside(source_v, height);

  const torch::Tensor grid = torch::stack({normalised(source_u, width), normalised(source_v, height)}, 3);
  const auto options = torch::nn::functional::GridSampleFuncOptions()
                           .mode(torch::kBilinear)
                           .padding_mode(torch::kBorder)
                           .align_corners(true);
  return {torch::nn::functional::grid_sample(source, grid, options), valid.unsqueeze(1)};
}

}  // namespace alight
