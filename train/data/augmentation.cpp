#include "train/data/augmentation.hpp"

#include <array>
#include <stdexcept>
#include <utility>
#include <vector>

#include "foundation/config_reader.hpp"
#include "train/data/batch_geometry.hpp"

namespace alight {
namespace {

/// Sets these draws apart from those of the densities, which use the key's seed as it is.
constexpr std::uint64_t kStream = 0xA0761D6478BD642FULL;

/// What is stacked in a batch.
constexpr std::array<torch::Tensor Batch::*, 15> kStacked{&Batch::left,          &Batch::right,
                                                          &Batch::previous,      &Batch::next,
                                                          &Batch::sparse_m,      &Batch::offset_s,
                                                          &Batch::has_right,     &Batch::has_previous,
                                                          &Batch::has_next,      &Batch::T_previous_camera,
                                                          &Batch::T_next_camera, &Batch::intrinsics_px,
                                                          &Batch::baseline_m,    &Batch::height_m,
                                                          &Batch::down_camera};

/// What is drawn for one sample.
struct Lot {
  bool horizontal_flip, vertical_flip, jitter;
  int quarter_turns;
  double brightness, contrast, saturation;
};

Lot draw(const AugmentationConfig& c, torch::Generator generator) {
  const torch::Tensor lots = torch::rand({8}, generator, torch::kFloat64);
  const auto u = [&](std::int64_t i) { return lots[i].item<double>(); };
  const auto factor = [&](std::int64_t i, double max_change) { return 1 + max_change * (2 * u(i) - 1); };
  Lot lot{};
  lot.horizontal_flip = u(0) < c.horizontal_flip_probability;
  lot.vertical_flip = u(1) < c.vertical_flip_probability;
  lot.quarter_turns = u(2) < c.quarter_turn_probability ? 1 + static_cast<int>(3 * u(3)) : 0;
  lot.jitter = u(4) < c.jitter_probability;
  lot.brightness = factor(5, c.max_brightness);
  lot.contrast = factor(6, c.max_contrast);
  lot.saturation = factor(7, c.max_saturation);
  return lot;
}

/// Luma of ITU-R BT.601. @param image [1,3,H,W] @returns [1,1,H,W]
torch::Tensor grey(const torch::Tensor& image) {
  return (image * torch::tensor({0.299F, 0.587F, 0.114F}).view({1, 3, 1, 1})).sum(1, true);
}

/// Contrast turns about the mean grey of the left view in all views: a mean of its own in each would change their
/// colours differently.
void jitter(Batch& sample, const Lot& lot) {
  const torch::Tensor mean_grey = grey(sample.left).mean();
  const auto recoloured = [&](const torch::Tensor& image) {
    const torch::Tensor saturated = lot.saturation * image + (1 - lot.saturation) * grey(image);
    const torch::Tensor contrasted = lot.contrast * saturated + (1 - lot.contrast) * mean_grey;
    return (lot.brightness * contrasted).clamp(0, 1);
  };
  sample.left = recoloured(sample.left);
  if (sample.has_right.item<bool>()) sample.right = recoloured(sample.right);
  if (sample.has_previous.item<bool>()) sample.previous = recoloured(sample.previous);
  if (sample.has_next.item<bool>()) sample.next = recoloured(sample.next);
}

Batch augmented(Batch sample, const Lot& lot) {
  if (lot.horizontal_flip) sample = flip_horizontally(std::move(sample));
  if (lot.vertical_flip) sample = flip_vertically(std::move(sample));
  if (lot.quarter_turns > 0) sample = turn(std::move(sample), lot.quarter_turns);
  if (lot.jitter) jitter(sample, lot);
  return sample;
}

Batch only(const Batch& batch, std::int64_t i) {
  Batch sample = batch;
  for (const auto field : kStacked) sample.*field = (batch.*field).slice(0, i, i + 1);
  return sample;
}

Batch joined(const std::vector<Batch>& samples) {
  Batch batch = samples.front();
  for (const auto field : kStacked) {
    std::vector<torch::Tensor> parts;
    for (const Batch& sample : samples) parts.push_back(sample.*field);
    batch.*field = torch::cat(parts);
  }
  return batch;
}

}  // namespace

void bind(Binder& b, AugmentationConfig& c) {
  b.field("horizontal_flip_probability", c.horizontal_flip_probability,
          "how often left and right are exchanged, and the cameras with them", between(0, 1));
  b.field("vertical_flip_probability", c.vertical_flip_probability, "how often up and down are exchanged",
          between(0, 1));
  b.field("quarter_turn_probability", c.quarter_turn_probability,
          "how often the view is turned by 90, 180 or 270 degrees; needs square cut-outs", between(0, 1));
  b.field("jitter_probability", c.jitter_probability, "how often the colours change", between(0, 1));
  b.field("max_brightness", c.max_brightness, "largest change of the brightness, as a share", between(0, 1));
  b.field("max_contrast", c.max_contrast, "largest change of the contrast, as a share", between(0, 1));
  b.field("max_saturation", c.max_saturation, "largest change of the saturation, as a share", between(0, 1));
}

Batch augment(const Batch& batch, const AugmentationConfig& config, const DrawKey& key) {
  if (config.quarter_turn_probability > 0 && batch.left.size(2) != batch.left.size(3)) {
    throw std::invalid_argument("augment: quarter turns need square images");
  }
  if (config.horizontal_flip_probability <= 0 && config.vertical_flip_probability <= 0 &&
      config.quarter_turn_probability <= 0 && config.jitter_probability <= 0) {
    return batch;
  }
  std::vector<Batch> samples;
  for (std::int64_t i = 0; i < batch.left.size(0); ++i) {
    const std::uint64_t seed = mixed_seed(key.seed ^ kStream, key.step, key.first + i + 1);
    samples.push_back(augmented(only(batch, i), draw(config, at::detail::createCPUGenerator(seed))));
  }
  return joined(samples);
}

}  // namespace alight
