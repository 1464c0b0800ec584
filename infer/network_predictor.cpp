#include "infer/network_predictor.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "configs/errors.hpp"
#include "geometry/depth_map.hpp"
#include "models/altitude_plane.hpp"
#include "models/checkpoint.hpp"
#include "models/depth_conversion.hpp"
#include "models/device.hpp"
#include "models/fold_batch_norm.hpp"

namespace alight {
namespace {

constexpr int kWarmUpRuns = 2;  // oneDNN's kernels are made in the first

struct ImagePyramid : EncodedImage {
  std::vector<torch::Tensor> maps;  // [0] float32, the others of the network's type
  torch::Tensor prior_m;            // [1,1,H,W], of the network's depth kind
};

bool processor_has_bfloat16() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx512bf16") != 0;
#else
  return false;
#endif
}

torch::Dtype number_type(NetworkPrecision precision, torch::Device device) {
  switch (precision) {
    case NetworkPrecision::kFloat32:
      break;
    case NetworkPrecision::kBfloat16:
      return torch::kBFloat16;
    case NetworkPrecision::kFloat16:
      if (device.is_cuda()) return torch::kFloat16;
      throw ConfigError("network.precision: float16 needs a CUDA device; use bfloat16, float32 or auto");
    case NetworkPrecision::kAuto:
      if (device.is_cuda()) return torch::kFloat16;
      if (processor_has_bfloat16()) return torch::kBFloat16;
  }
  return torch::kFloat32;
}

/// [1,3,H,W] float32, RGB in 0..1, as the network was trained with; undefined for an empty image
torch::Tensor image_tensor(const cv::Mat& image) {
  if (image.empty()) return {};
  cv::Mat rgb;
  cv::cvtColor(image, rgb, image.channels() == 3 ? cv::COLOR_BGR2RGB : cv::COLOR_GRAY2RGB);
  const torch::Tensor bytes = torch::from_blob(rgb.data, {1, rgb.rows, rgb.cols, 3}, torch::kUInt8);
  return bytes.permute({0, 3, 1, 2}).to(torch::kFloat32).mul_(1.0F / 255.0F).contiguous();
}

/// [1,1,H,W] float32
torch::Tensor depth_tensor(const cv::Mat& depth_m) {
  torch::Tensor tensor = torch::empty({1, 1, depth_m.rows, depth_m.cols}, torch::kFloat32);
  depth_m.copyTo(cv::Mat(depth_m.size(), CV_32FC1, tensor.data_ptr<float>()));
  return tensor;
}

class NetworkPredictor : public DepthPredictor {
 public:
  NetworkPredictor(DepthCompletionNet net, const RectifiedRig& rig, torch::Device device, torch::Dtype type)
      : net_(std::move(net)), rig_(rig), device_(device), type_(type) {
    net_->eval();
    net_->to(device_, type_);
    for (torch::Tensor& parameter : net_->parameters()) {
      parameter.set_requires_grad(false);
      if (parameter.dim() == 4) parameter.set_data(parameter.contiguous(torch::MemoryFormat::ChannelsLast));
    }
    warm_up();
  }

  std::unique_ptr<EncodedImage> encode(const PredictorView& view) override {
    check_size(view.left);
    if (!view.right.empty()) check_size(view.right);
    const torch::InferenceMode guard;
    auto pyramid = std::make_unique<ImagePyramid>();
    pyramid->prior_m = prior(view);
    const torch::Tensor input = net_->image_input(
        {on_device(image_tensor(view.left)), on_device(image_tensor(view.right)), pyramid->prior_m,
         torch::full({1}, rig_.intrinsics.fx_px * rig_.baseline_m, device_)});
    pyramid->maps = pyramid_of(input, net_->image_features(to_network(input)));
    return pyramid;
  }

  cv::Mat refine(const EncodedImage& image, const cv::Mat& sparse_m) override {
    check_size(sparse_m);
    const torch::InferenceMode guard;
    const bool perspective = net_->config().depth_kind == DepthKind::kPerspective;
    const cv::Mat input_m = perspective ? plane_to_perspective(sparse_m, rig_.intrinsics) : sparse_m;
    const auto& pyramid = dynamic_cast<const ImagePyramid&>(image);
    const torch::Tensor input = net_->depth_input(on_device(depth_tensor(input_m)), pyramid.prior_m);
    const torch::Tensor predicted =
        net_->decode(pyramid.maps, pyramid_of(input, net_->depth_features(to_network(input))))
            .to(torch::kCPU, torch::kFloat32)
            .contiguous();
    const cv::Mat depth_m = cv::Mat(sparse_m.size(), CV_32FC1, predicted.data_ptr<float>()).clone();
    return perspective ? perspective_to_plane(depth_m, rig_.intrinsics) : depth_m;
  }

 private:
  torch::Tensor prior(const PredictorView& view) const {
    const PinholeIntrinsics& k = rig_.intrinsics;
    const torch::Tensor intrinsics_px = torch::tensor({k.fx_px, k.fy_px, k.cx_px, k.cy_px}, torch::kFloat32);
    const torch::Tensor plane_m = altitude_plane(view.height_m, view.down_camera, intrinsics_px, k.height_px,
                                                 k.width_px, net_->config().max_depth_m);
    return on_device(to_network_depth(plane_m, intrinsics_px.unsqueeze(0), net_->config().depth_kind));
  }

  torch::Tensor on_device(const torch::Tensor& x) const { return x.defined() ? x.to(device_) : x; }
  torch::Tensor to_network(const torch::Tensor& x) const {
    return x.to(type_).contiguous(torch::MemoryFormat::ChannelsLast);
  }
  static std::vector<torch::Tensor> pyramid_of(const torch::Tensor& input,
                                               const std::vector<torch::Tensor>& features) {
    std::vector<torch::Tensor> maps{input};
    maps.insert(maps.end(), features.begin(), features.end());
    return maps;
  }

  void warm_up() {
    PredictorView view;
    view.left = view.right = cv::Mat(rig_.intrinsics.size(), CV_8UC3, cv::Scalar::all(128));
    view.down_camera = Eigen::Vector3d::UnitZ();
    const cv::Mat no_points = cv::Mat::zeros(rig_.intrinsics.size(), CV_32FC1);
    for (int i = 0; i < kWarmUpRuns; ++i) refine(*encode(view), no_points);
  }

  void check_size(const cv::Mat& map) const {
    if (map.size() != rig_.intrinsics.size()) {
      throw std::invalid_argument("NetworkPredictor: image and depth must have the camera's size");
    }
  }

  DepthCompletionNet net_;
  RectifiedRig rig_;
  torch::Device device_;
  torch::Dtype type_;
};

}  // namespace

std::unique_ptr<DepthPredictor> make_network_predictor(const std::filesystem::path& checkpoint,
                                                       const RectifiedRig& rig, const NetworkConfig& config) {
  const int machine = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  at::set_num_threads(config.threads > 0 ? config.threads : machine);
  at::globalContext().setFlushDenormal(true);
  const torch::Device device = find_device(config.device);
  DepthCompletionNet net = load_network(checkpoint).net;
  if (net->config().normalization == Normalization::kBatch) net = fold_batch_norm(net);
  return std::make_unique<NetworkPredictor>(net, rig, device, number_type(config.precision, device));
}

}  // namespace alight
