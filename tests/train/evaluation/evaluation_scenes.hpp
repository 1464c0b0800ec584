#pragma once

#include <functional>
#include <string>
#include <utility>

#include "geometry/rig/stereo_rectification.hpp"
#include "tests/train/data/memory_source.hpp"
#include "train/evaluation/methods/depth_method.hpp"

namespace alight::test {

/// The rig of tests/train/data/memory_source.hpp, with a LiDAR that looks along the optical axis.
inline RectifiedRig scene_rig(int side_px = 48) {
  RectifiedRig rig;
  rig.intrinsics = {40, 40, 0.5 * (side_px - 1), 0.5 * (side_px - 1), side_px, side_px};
  rig.baseline_m = 0.01;
  rig.T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return rig;
}

/// A method that is a function.
class FakeMethod : public DepthMethod {
 public:
  using Function = std::function<torch::Tensor(const DepthSample&, const torch::Tensor&)>;
  FakeMethod(std::string name, Function function) : name_(std::move(name)), function_(std::move(function)) {}
  std::string name() const override { return name_; }
  torch::Tensor complete(const DepthSample& sample, const torch::Tensor& fed_m) const override {
    return function_(sample, fed_m);
  }

 private:
  std::string name_;
  Function function_;
};

inline std::unique_ptr<DepthMethod> fake(std::string name, FakeMethod::Function function) {
  return std::make_unique<FakeMethod>(std::move(name), std::move(function));
}

}  // namespace alight::test
