#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include <torch/torch.h>

#include "train/data/sample_source.hpp"

namespace alight::test {

/// Samples held in memory.
class MemorySource : public SampleSource {
 public:
  explicit MemorySource(std::vector<DepthSample> samples) : samples_(std::move(samples)) {}
  std::size_t size() const override { return samples_.size(); }
  DepthSample get(std::size_t index) override { return samples_.at(index); }

 private:
  std::vector<DepthSample> samples_;
};

/// An image of whole 8-bit values, as files hold them.
inline torch::Tensor random_image(std::int64_t height, std::int64_t width) {
  return torch::randint(0, 256, {3, height, width}).to(torch::kFloat32) / 255.0;
}

/// Level ground at a depth of 6..30 m with a block 3 m high, sparse points on both; bright where near. The
/// views before, after and to the right are those of a vehicle that hovers.
inline DepthSample scene_sample(std::int64_t index, std::int64_t height = 48, std::int64_t width = 48) {
  torch::manual_seed(static_cast<std::uint64_t>(100 + index));
  const double ground_m = 6 + 24 * torch::rand({}).item<double>();
  DepthSample sample;
  sample.dense = torch::full({1, height, width}, ground_m);
  sample.dense.slice(1, height / 4, height / 2).slice(2, width / 4, width / 2) -= 3;
  sample.sparse = sample.dense * (torch::rand({1, height, width}) < 0.2).to(torch::kFloat32);
  sample.offset_s = torch::rand({1, height, width}) * (sample.sparse > 0).to(torch::kFloat32);
  const torch::Tensor shade = torch::round(255 * 6 / sample.dense.expand({3, height, width})) / 255;
  sample.left = shade.clamp(0, 1).contiguous();
  sample.right = sample.left.clone();
  sample.previous = sample.left.clone();
  sample.next = sample.left.clone();
  sample.T_previous_camera = torch::eye(4);
  sample.T_next_camera = torch::eye(4);
  sample.intrinsics = torch::tensor(
      {40.0F, 40.0F, 0.5F * static_cast<float>(width - 1), 0.5F * static_cast<float>(height - 1)});
  sample.down_camera = torch::tensor({0.0F, 0.0F, 1.0F});
  sample.has_right = sample.has_previous = sample.has_next = true;
  sample.baseline_m = 0.01;
  sample.height_m = ground_m + 1;  // the take-off place lies a metre lower
  sample.index = index;
  return sample;
}

inline MemorySource scenes(std::int64_t count, std::int64_t first = 0) {
  std::vector<DepthSample> samples;
  for (std::int64_t i = 0; i < count; ++i) samples.push_back(scene_sample(first + i));
  return MemorySource(std::move(samples));
}

}  // namespace alight::test
