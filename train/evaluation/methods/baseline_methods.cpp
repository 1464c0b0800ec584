#include "train/evaluation/methods/baseline_methods.hpp"

#include <functional>
#include <utility>

#include "foundation/config_reader.hpp"
#include "geometry/depth_map.hpp"
#include "models/inputs/altitude_plane.hpp"
#include "train/evaluation/methods/delaunay.hpp"
#include "train/evaluation/methods/ip_basic.hpp"

namespace alight {
namespace {

class Interpolation : public DepthMethod {
 public:
  Interpolation(std::string name, std::function<cv::Mat(const cv::Mat&)> fill)
      : name_(std::move(name)), fill_(std::move(fill)) {}
  std::string name() const override { return name_; }
  torch::Tensor complete(const DepthSample&, const torch::Tensor& fed_m) const override {
    return depth_to_tensor(fill_(tensor_to_depth(fed_m)));
  }

 private:
  std::string name_;
  std::function<cv::Mat(const cv::Mat&)> fill_;
};

class AltitudePlane : public DepthMethod {
 public:
  explicit AltitudePlane(double max_depth_m) : max_depth_m_(max_depth_m) {}
  std::string name() const override { return "altitude plane"; }
  torch::Tensor complete(const DepthSample& sample, const torch::Tensor& fed_m) const override {
    return altitude_planes(torch::tensor({sample.height_m}, torch::kFloat64), sample.down_camera.unsqueeze(0),
                           sample.intrinsics.unsqueeze(0), fed_m.size(1), fed_m.size(2), max_depth_m_)
        .squeeze(0);
  }

 private:
  double max_depth_m_;
};

}  // namespace

void bind(Binder& b, BaselineConfig& c) {
  b.field("max_depth_m", c.max_depth_m, "farthest depth of the altitude plane", positive());
  b.field("ip_basic_range_m", c.ip_basic_range_m, "IP-Basic inverts depths as this minus depth", positive());
}

std::unique_ptr<DepthMethod> make_altitude_plane(const BaselineConfig& config) {
  return std::make_unique<AltitudePlane>(config.max_depth_m);
}

DepthMethods make_baselines(const BaselineConfig& config) {
  DepthMethods methods;
  const auto add = [&](const char* name, std::function<cv::Mat(const cv::Mat&)> fill) {
    methods.push_back(std::make_unique<Interpolation>(name, std::move(fill)));
  };
  add("nearest", [](const cv::Mat& fed_m) { return fill_nearest(fed_m); });
  add("Delaunay", [](const cv::Mat& fed_m) { return fill_delaunay(fed_m); });
  add("Delaunay, inverse depth",
      [](const cv::Mat& fed_m) { return fill_delaunay(fed_m, LinearQuantity::kInverseDepth); });
  add("IP-Basic",
      [range_m = config.ip_basic_range_m](const cv::Mat& fed_m) { return fill_ip_basic(fed_m, range_m); });
  methods.push_back(make_altitude_plane(config));
  return methods;
}

}  // namespace alight
