#include "train/evaluation/methods/network_method.hpp"

#include <utility>

#include "models/depth_conversion.hpp"
#include "models/inputs/altitude_plane.hpp"

namespace alight {
namespace {

class NetworkMethod : public DepthMethod {
 public:
  NetworkMethod(std::string name, LoadedNetwork network)
      : name_(std::move(name)), network_(std::move(network)) {
    network_.net->eval();
  }
  std::string name() const override { return name_; }
  torch::Tensor complete(const DepthSample& sample, const torch::Tensor& fed_m) const override {
    const torch::NoGradGuard no_grad;
    const DepthCompletionConfig& config = network_.config;
    const torch::Tensor intrinsics_px = sample.intrinsics.unsqueeze(0);
    const torch::Tensor plane_m =
        altitude_planes(torch::tensor({sample.height_m}, torch::kFloat64), sample.down_camera.unsqueeze(0),
                        intrinsics_px, fed_m.size(1), fed_m.size(2), config.max_depth_m);
    const SceneView view{sample.left.unsqueeze(0), sample.right.unsqueeze(0),
                         to_network_depth(plane_m, intrinsics_px, config.depth_kind),
                         intrinsics_px.select(1, 0) * sample.baseline_m};
    DepthCompletionNet net = network_.net;  // a handle
    const torch::Tensor depth =
        net->forward(view, to_network_depth(fed_m.unsqueeze(0), intrinsics_px, config.depth_kind));
    return from_network_depth(depth, intrinsics_px, config.depth_kind).squeeze(0);
  }

 private:
  std::string name_;
  LoadedNetwork network_;
};

}  // namespace

std::unique_ptr<DepthMethod> make_network_method(std::string name, LoadedNetwork network) {
  return std::make_unique<NetworkMethod>(std::move(name), std::move(network));
}

}  // namespace alight
