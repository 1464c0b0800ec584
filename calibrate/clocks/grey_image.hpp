#pragma once

#include <opencv2/imgproc.hpp>

namespace alight {

/// A camera's image (CV_8UC1 or CV_8UC3 BGR) as CV_8UC1; a copy in either case.
inline cv::Mat to_grey(const cv::Mat& image) {
  if (image.channels() == 1) return image.clone();
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

}  // namespace alight
