#pragma once

#include <limits>
#include <memory>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace alight {

/// What an image became in the network: made once, used for every refinement.
class EncodedImage {
 public:
  EncodedImage() = default;
  EncodedImage(const EncodedImage&) = delete;
  EncodedImage& operator=(const EncodedImage&) = delete;
  virtual ~EncodedImage() = default;
};

/// What a predictor is told of a moment besides LiDAR points. Only `left` is always there.
struct PredictorView {
  cv::Mat left;     ///< rectified, cropped, CV_8UC3 BGR or CV_8UC1
  cv::Mat right{};  ///< the same of the right camera; empty: mono or lost
  double height_m = std::numeric_limits<double>::quiet_NaN();  ///< above take-off; NaN: unknown
  Eigen::Vector3d down_camera =
      Eigen::Vector3d::Zero();  ///< the world's down in camera coordinates, unit length
};

/// Depth from an image and however many LiDAR points there are (paper 3.2). Late fusion lets the engine encode an image
/// once and run the rest again as points arrive. The engine knows only this interface.
class DepthPredictor {
 public:
  DepthPredictor() = default;
  DepthPredictor(const DepthPredictor&) = delete;
  DepthPredictor& operator=(const DepthPredictor&) = delete;
  virtual ~DepthPredictor() = default;

  virtual std::unique_ptr<EncodedImage> encode(const PredictorView& view) = 0;
  /// @param image from encode of the same predictor. @param sparse_m CV_32FC1 plane depth in metres, 0 = no point; all
  /// zero: from the image alone. @returns CV_32FC1 plane depth of the same size
  virtual cv::Mat refine(const EncodedImage& image, const cv::Mat& sparse_m) = 0;
};

}  // namespace alight
