#include "train/density_sampling.hpp"

#include <stdexcept>

namespace alight {
namespace {

/// Uniform numbers in [0, 1), one a sample (equal ones for a draw by batch). @returns [B,1,1,1]
torch::Tensor draw(std::int64_t batch, const DensitySamplingConfig& config, torch::Generator& generator) {
  const std::int64_t count = config.draw == DensityDraw::kBatch ? 1 : batch;
  return torch::rand({count, 1, 1, 1}, generator, torch::kFloat32).expand({batch, 1, 1, 1});
}

}  // namespace

void bind(Binder& b, DensitySamplingConfig& c) {
  b.choice("mode", c.mode, {{"share", DensityMode::kShare}, {"window", DensityMode::kWindow}},
           "feed a random share of the points, or those of an accumulation window");
  b.choice("draw", c.draw, {{"batch", DensityDraw::kBatch}, {"sample", DensityDraw::kSample}},
           "one draw for a batch (the paper) or for each of its samples");
  b.field("no_lidar_probability", c.no_lidar_probability, "how often no point is fed", between(0, 1));
  b.field("min_share", c.min_share, "smallest share of the points fed", between(0, 1));
  b.field("max_share", c.max_share, "largest share of the points fed", between(0, 1));
  b.field("window_begin_s", c.window_begin_s, "begin of the window, relative to the image");
  b.field("window_min_s", c.window_min_s, "shortest window", at_least(0));
  b.field("window_max_s", c.window_max_s, "longest window", at_least(0));
  b.field("no_image_probability", c.no_image_probability,
          "how often the image is black, of draws with points", between(0, 1));
  b.check("max_share", c.max_share >= c.min_share, "expected at least min_share");
  b.check("window_max_s", c.window_max_s >= c.window_min_s, "expected at least window_min_s");
}

torch::Tensor keep_share(const torch::Tensor& sparse_m, const torch::Tensor& share,
                         torch::Generator& generator) {
  const torch::Tensor lot =
      torch::rand(sparse_m.sizes(), generator, torch::kFloat32);  // below 1, so 1 keeps all
  return sparse_m * (lot < share).to(sparse_m.dtype());
}

torch::Tensor keep_window(const torch::Tensor& sparse_m, const torch::Tensor& offset_s, double begin_s,
                          const torch::Tensor& end_s) {
  return sparse_m * ((offset_s >= begin_s) & (offset_s < end_s)).to(sparse_m.dtype());
}

NetworkInput sample_density(const torch::Tensor& image, const torch::Tensor& sparse_m,
                            const torch::Tensor& offset_s, const DensitySamplingConfig& config,
                            torch::Generator& generator) {
  if (image.dim() != 4 || sparse_m.dim() != 4 || sparse_m.sizes() != offset_s.sizes()) {
    throw std::invalid_argument("sample_density: expected image [B,3,H,W], sparse and offset [B,1,H,W]");
  }
  const std::int64_t batch = sparse_m.size(0);
  const torch::Tensor with_lidar = draw(batch, config, generator) >= config.no_lidar_probability;
  const torch::Tensor amount = draw(batch, config, generator);
  const torch::Tensor without_image = draw(batch, config, generator) < config.no_image_probability;

  NetworkInput input;
  if (config.mode == DensityMode::kShare) {
    const torch::Tensor share = config.min_share + (config.max_share - config.min_share) * amount;
    input.sparse_m = keep_share(sparse_m, share, generator);
  } else {
    const torch::Tensor length_s = config.window_min_s + (config.window_max_s - config.window_min_s) * amount;
    input.sparse_m = keep_window(sparse_m, offset_s, config.window_begin_s, config.window_begin_s + length_s);
  }
  input.sparse_m = input.sparse_m * with_lidar.to(sparse_m.dtype());
  input.image = image * (~(with_lidar & without_image)).to(image.dtype());
  return input;
}

}  // namespace alight
