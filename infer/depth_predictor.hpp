#pragma once

#include <memory>

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

/// Depth from an image and however many LiDAR points there are (paper 3.2). Late fusion lets the engine encode an image
/// once and run the rest again as points arrive. The engine knows only this interface.
class DepthPredictor {
 public:
  DepthPredictor() = default;
  DepthPredictor(const DepthPredictor&) = delete;
  DepthPredictor& operator=(const DepthPredictor&) = delete;
  virtual ~DepthPredictor() = default;

  /// @param image rectified, cropped left image, CV_8UC3 BGR or CV_8UC1
  virtual std::unique_ptr<EncodedImage> encode(const cv::Mat& image) = 0;
  /// @param image from encode of the same predictor. @param sparse_m CV_32FC1 plane depth in metres, 0 = no point; all
  /// zero: from the image alone. @returns CV_32FC1 plane depth of the same size
  virtual cv::Mat refine(const EncodedImage& image, const cv::Mat& sparse_m) = 0;
};

}  // namespace alight
