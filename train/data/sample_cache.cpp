#include "train/data/sample_cache.hpp"

#include <algorithm>

#include <torch/torch.h>

namespace alight {
namespace {

// Plain loops here and in batch.cpp: torch's operators would start a thread pool of their own in every loader
// thread.
std::vector<std::uint8_t> to_bytes(const torch::Tensor& image, bool present) {
  if (!present) return {};
  const torch::Tensor contiguous = image.contiguous();
  const float* values = contiguous.data_ptr<float>();
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(contiguous.numel()));
  std::transform(values, values + bytes.size(), bytes.begin(), [](float value) {
    return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 1.0F) * 255.0F + 0.5F);
  });
  return bytes;
}

std::vector<float> to_floats(const torch::Tensor& map) {
  const torch::Tensor contiguous = map.contiguous();
  const float* values = contiguous.data_ptr<float>();
  return {values, values + contiguous.numel()};
}

}  // namespace

std::size_t CompactSample::bytes() const {
  return left.size() + right.size() + previous.size() + next.size() +
         sizeof(float) * (sparse_m.size() + offset_s.size());
}

CompactSample compact(const DepthSample& sample) {
  CompactSample small;
  small.left = to_bytes(sample.left, true);
  small.right = to_bytes(sample.right, sample.has_right);
  small.previous = to_bytes(sample.previous, sample.has_previous);
  small.next = to_bytes(sample.next, sample.has_next);
  small.sparse_m = to_floats(sample.sparse);
  small.offset_s = to_floats(sample.offset_s);
  small.height_px = sample.left.size(1);
  small.width_px = sample.left.size(2);
  small.rest = sample;
  small.rest.left = small.rest.right = small.rest.previous = small.rest.next = torch::Tensor();
  small.rest.sparse = small.rest.offset_s = small.rest.dense = torch::Tensor();
  return small;
}

std::shared_ptr<const CompactSample> SampleCache::get(std::size_t index) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (samples_.at(index)) return samples_[index];
  }
  auto sample = std::make_shared<const CompactSample>(compact(source_.get(index)));
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!samples_[index] && used_bytes_ + sample->bytes() <= limit_bytes_) {
    used_bytes_ += sample->bytes();
    samples_[index] = sample;
  }
  return sample;
}

}  // namespace alight
