#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "train/data/sample_source.hpp"

namespace alight {

/// A sample as small as its files hold it: 8-bit images, a quarter of the tensors' size.
struct CompactSample {
  std::vector<std::uint8_t> left, right, previous, next;  ///< 3 x H x W, RGB; empty where the sample has none
  std::vector<float> sparse_m, offset_s;                  ///< H x W
  std::int64_t height_px = 0;
  std::int64_t width_px = 0;
  DepthSample rest;  ///< poses, intrinsics, flags; its images and maps are undefined

  std::size_t bytes() const;
};

/// Keeps decoded samples in memory up to a limit; the first come stay. What does not fit is read again every
/// time.
class SampleCache {
 public:
  SampleCache(SampleSource& source, std::size_t limit_bytes) : source_(source), limit_bytes_(limit_bytes) {
    samples_.resize(source.size());
  }
  /// Called from several threads at once. @throws DataError as the source
  std::shared_ptr<const CompactSample> get(std::size_t index);
  std::size_t size() const { return samples_.size(); }

 private:
  SampleSource& source_;
  std::size_t limit_bytes_;
  std::size_t used_bytes_ = 0;
  std::vector<std::shared_ptr<const CompactSample>> samples_;
  std::mutex mutex_;
};

/// 0..1 as 8 bit. @param sample images [3,H,W] float32
CompactSample compact(const DepthSample& sample);

}  // namespace alight
