#include "train/data/density_sampling.hpp"

#include <cmath>
#include <stdexcept>

#include "foundation/config_reader.hpp"

namespace alight {
namespace {

/// What is drawn for one sample.
struct DensityLot {
  bool lidar, image, right, height, window;
  double share, begin_s, end_s;
};

DensityLot draw(const DensitySamplingConfig& c, torch::Generator& generator) {
  const torch::Tensor lots = torch::rand({8}, generator, torch::kFloat64);
  const auto u = [&](std::int64_t i) { return lots[i].item<double>(); };
  DensityLot lot{};
  lot.lidar = u(0) >= c.no_lidar_probability;
  lot.share = c.min_share + (c.max_share - c.min_share) * u(1);
  lot.image = !(lot.lidar && u(2) < c.no_image_probability);
  lot.right = lot.image && u(3) >= c.no_right_probability;
  lot.height = u(4) >= c.no_height_probability;
  lot.window = c.mode == DensityMode::kWindow || (c.mode == DensityMode::kMixed && u(5) < 0.5);
  lot.begin_s = c.window_begin_min_s + (c.window_begin_max_s - c.window_begin_min_s) * u(6);
  lot.end_s = lot.begin_s + c.window_min_s * std::pow(c.window_max_s / c.window_min_s, u(7));
  return lot;
}

torch::Tensor feed(const torch::Tensor& sparse_m, const torch::Tensor& offset_s, const DensityLot& lot,
                   torch::Generator& generator) {
  if (!lot.lidar) return torch::zeros_like(sparse_m);
  if (lot.window)
    return keep_window(sparse_m, offset_s, lot.begin_s, torch::full({}, lot.end_s, offset_s.options()));
  return keep_share(sparse_m, torch::tensor(lot.share), generator);
}

}  // namespace

void bind(Binder& b, DensitySamplingConfig& c) {
  b.choice("mode", c.mode,
           {{"share", DensityMode::kShare}, {"window", DensityMode::kWindow}, {"mixed", DensityMode::kMixed}},
           "feed a random share of the points, those of an accumulation window, or either");
  b.choice("draw", c.draw, {{"batch", DensityDraw::kBatch}, {"sample", DensityDraw::kSample}},
           "one draw for a batch (the paper) or for each of its samples");
  b.field("no_lidar_probability", c.no_lidar_probability, "how often no point is fed", between(0, 1));
  b.field("min_share", c.min_share, "smallest share of the points fed", between(0, 1));
  b.field("max_share", c.max_share, "largest share of the points fed", between(0, 1));
  b.field("window_begin_min_s", c.window_begin_min_s, "earliest begin of a window, relative to the image");
  b.field("window_begin_max_s", c.window_begin_max_s, "latest begin of a window, relative to the image");
  b.field("window_min_s", c.window_min_s, "shortest window", between(0.001, 60));
  b.field("window_max_s", c.window_max_s, "longest window", between(0.001, 60));
  b.field("no_image_probability", c.no_image_probability,
          "how often both cameras are black, of draws with points", between(0, 1));
  b.field("no_right_probability", c.no_right_probability, "how often the right camera is black",
          between(0, 1));
  b.field("no_height_probability", c.no_height_probability, "how often the height is unknown", between(0, 1));
  b.check("window_begin_max_s", c.window_begin_max_s >= c.window_begin_min_s,
          "expected at least window_begin_min_s");
  b.check("max_share", c.max_share >= c.min_share, "expected at least min_share");
  b.check("window_max_s", c.window_max_s >= c.window_min_s, "expected at least window_min_s");
}

torch::Tensor keep_share(const torch::Tensor& sparse_m, const torch::Tensor& share,
                         torch::Generator& generator) {
  const torch::Tensor lot = torch::rand(sparse_m.sizes(), generator, torch::kFloat32)
                                .to(sparse_m.device());  // below 1, so 1 keeps all
  return sparse_m * (lot < share.to(sparse_m.device())).to(sparse_m.dtype());
}

torch::Tensor keep_window(const torch::Tensor& sparse_m, const torch::Tensor& offset_s, double begin_s,
                          const torch::Tensor& end_s) {
  return sparse_m * ((offset_s >= begin_s) & (offset_s < end_s)).to(sparse_m.dtype());
}

NetworkInput sample_density(const torch::Tensor& image, const torch::Tensor& right,
                            const torch::Tensor& sparse_m, const torch::Tensor& offset_s,
                            const DensitySamplingConfig& config, const DrawKey& key) {
  if (image.dim() != 4 || image.sizes() != right.sizes() || sparse_m.dim() != 4 ||
      sparse_m.sizes() != offset_s.sizes()) {
    throw std::invalid_argument("sample_density: expected images [B,3,H,W], sparse and offset [B,1,H,W]");
  }
  torch::Generator of_batch = at::detail::createCPUGenerator(mixed_seed(key.seed, key.step, 0));
  const DensityLot lot_of_batch = draw(config, of_batch);
  NetworkInput input{image.clone(), right.clone(), torch::empty_like(sparse_m),
                     torch::ones({image.size(0)}, image.options().dtype(torch::kBool))};
  for (std::int64_t i = 0; i < image.size(0); ++i) {
    torch::Generator of_sample =
        at::detail::createCPUGenerator(mixed_seed(key.seed, key.step, key.first + i + 1));
    const DensityLot lot = config.draw == DensityDraw::kBatch ? lot_of_batch : draw(config, of_sample);
    input.sparse_m[i].copy_(feed(sparse_m[i], offset_s[i], lot, of_sample));
    if (!lot.image) input.image[i].zero_();
    if (!lot.right) input.right[i].zero_();
    if (!lot.height) input.knows_height[i].fill_(false);
  }
  return input;
}

}  // namespace alight
