#include "infer/network/network_predictor.hpp"

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "geometry/depth_map.hpp"
#include "infer/network/onboard_network.hpp"
#include "models/depth_conversion.hpp"
#include "models/inputs/altitude_plane.hpp"

namespace alight {
namespace {

constexpr int kWarmUpRuns = 2;  // oneDNN's kernels are made in the first

struct ImagePyramid : EncodedImage {
  std::vector<torch::Tensor> decoder_part;  // of the network's type
  torch::Tensor prior_m;                    // [1,1,H,W], of the network's depth kind
};

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
  NetworkPredictor(OnboardNetwork network, const RectifiedRig& rig)
      : network_(std::move(network)), rig_(rig) {
    warm_up();
  }

  std::unique_ptr<EncodedImage> encode(const PredictorView& view) override {
    check_size(view.left);
    if (!view.right.empty()) check_size(view.right);
    const torch::InferenceMode guard;
    auto pyramid = std::make_unique<ImagePyramid>();
    pyramid->prior_m = prior(view);
    const torch::Tensor input = network_.net->image_input(
        {on_device(image_tensor(view.left)), on_device(image_tensor(view.right)), pyramid->prior_m,
         torch::full({1}, rig_.intrinsics.fx_px * rig_.baseline_m, network_.device)});
    pyramid->decoder_part = network_.decoder->image_part(
        feature_pyramid(input, network_.net->image_features(network_.prepare(input))));
    return pyramid;
  }

  cv::Mat refine(const EncodedImage& image, const cv::Mat& sparse_m) override {
    check_size(sparse_m);
    const torch::InferenceMode guard;
    const bool perspective = network_.net->config().depth_kind == DepthKind::kPerspective;
    const cv::Mat input_m = perspective ? plane_to_perspective(sparse_m, rig_.intrinsics) : sparse_m;
    const auto& pyramid = dynamic_cast<const ImagePyramid&>(image);
    const torch::Tensor input = network_.net->depth_input(on_device(depth_tensor(input_m)), pyramid.prior_m);
    const torch::Tensor predicted =
        network_.decoder
            ->decode(pyramid.decoder_part,
                     feature_pyramid(input, network_.net->depth_features(network_.prepare(input))))
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
                                                 k.width_px, network_.net->config().max_depth_m);
    return on_device(
        to_network_depth(plane_m, intrinsics_px.unsqueeze(0), network_.net->config().depth_kind));
  }

  torch::Tensor on_device(const torch::Tensor& x) const { return x.defined() ? x.to(network_.device) : x; }

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

  OnboardNetwork network_;
  RectifiedRig rig_;
};

}  // namespace

std::unique_ptr<DepthPredictor> make_network_predictor(const std::filesystem::path& checkpoint,
                                                       const RectifiedRig& rig, const NetworkConfig& config) {
  return std::make_unique<NetworkPredictor>(load_onboard_network(checkpoint, config), rig);
}

}  // namespace alight
