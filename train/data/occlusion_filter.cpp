#include "train/data/occlusion_filter.hpp"

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, OcclusionFilterConfig& c) {
  b.field("window_px", c.window_px, "side of the neighbourhood that may hide a point, odd; 0: off",
          between(0, 99));
  b.field("min_offset_s", c.min_offset_s, "points nearer in time to the image are always trusted",
          at_least(0));
  b.field("margin", c.margin, "share of its depth by which a hidden point lies behind its neighbours",
          between(0, 1));
  b.check("window_px", c.window_px == 0 || c.window_px % 2 == 1, "expected an odd number, or 0");
}

torch::Tensor drop_hidden_points(const torch::Tensor& sparse_m, const torch::Tensor& offset_s,
                                 const OcclusionFilterConfig& config) {
  if (config.window_px == 0) return sparse_m;
  const torch::NoGradGuard no_grad;
  const torch::Tensor nearness =
      torch::where(sparse_m > 0, 1 / sparse_m.clamp_min(1e-3), torch::zeros_like(sparse_m));
  const torch::Tensor nearest =
      torch::max_pool2d(nearness, config.window_px, 1, config.window_px / 2);  // of the neighbourhood, 1 / m
  const torch::Tensor hidden =
      (nearness < nearest * (1 - config.margin)) & (offset_s.abs() > config.min_offset_s);
  return torch::where(hidden, torch::zeros_like(sparse_m), sparse_m);
}

}  // namespace alight
