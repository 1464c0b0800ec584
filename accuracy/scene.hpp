#pragma once

#include <cmath>
#include <random>

#include <opencv2/core.hpp>

#include "geometry/rig/stereo_rectification.hpp"

namespace alight::bench {

/// The paper's images after the crop: 352x352, f = 440 px, baseline 8 cm.
inline RectifiedRig paper_rig() {
  RectifiedRig rig;
  rig.intrinsics = {440, 440, 175.5, 175.5, 352, 352};
  rig.baseline_m = 0.08;
  return rig;
}

/// Gently rolling ground 20 m below with 2 cm of noise and a few boxes.
inline cv::Mat ground() {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.02);
  cv::Mat depth(352, 352, CV_32FC1);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      depth.at<float>(v, u) =
          static_cast<float>(20 + 0.3 * std::sin(u * 0.02) * std::cos(v * 0.017) + noise(random));
    }
  }
  for (int i = 0; i < 8; ++i) depth(cv::Rect(30 + 40 * i, 300 - 35 * i, 18, 25)).setTo(17.5);
  return depth;
}

inline cv::Mat textured(cv::Size size) {
  cv::Mat image(size, CV_8UC3);
  cv::RNG(2).fill(image, cv::RNG::UNIFORM, 0, 255);
  return image;
}

}  // namespace alight::bench
