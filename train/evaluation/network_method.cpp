#include "train/evaluation/network_method.hpp"

#include <utility>

#include "models/depth_conversion.hpp"

namespace alight {
namespace {

class NetworkMethod : public DepthMethod {
 public:
  NetworkMethod(std::string name, LoadedNetwork network)
      : name_(std::move(name)), network_(std::move(network)) {
    network_.net->eval();
  }
  std::string name() const override { return name_; }
  torch::Tensor complete(const DepthSample& sample, const torch::Tensor& fed_m,
                         const Eigen::Vector3d&) const override {
    const torch::NoGradGuard no_grad;
    const torch::Tensor intrinsics = sample.intrinsics.unsqueeze(0);
    const DepthKind kind = network_.config.depth_kind;
    DepthCompletionNet net = network_.net;  // a handle
    const torch::Tensor depth =
        net->forward(sample.left.unsqueeze(0), to_network_depth(fed_m.unsqueeze(0), intrinsics, kind));
    return from_network_depth(depth, intrinsics, kind).squeeze(0);
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
