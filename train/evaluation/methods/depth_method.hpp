#pragma once

#include <memory>
#include <string>
#include <vector>

#include <torch/torch.h>

#include "dataset/store/depth_dataset.hpp"

namespace alight {

/// Something that completes sparse depth.
class DepthMethod {
 public:
  virtual ~DepthMethod() = default;
  virtual std::string name() const = 0;
  /// Called from several threads at once.
  /// @param sample what else a method may look at: images, height, attitude, intrinsics; never its truth or unfed points
  /// @param fed_m [1,H,W] float32, plane depth in metres of the points to complete, 0 = none
  /// @returns [1,H,W] float32, plane depth in metres, 0 = unknown
  virtual torch::Tensor complete(const DepthSample& sample, const torch::Tensor& fed_m) const = 0;
};

using DepthMethods = std::vector<std::unique_ptr<DepthMethod>>;

}  // namespace alight
