#pragma once

#include <opencv2/core.hpp>

namespace alight {

/// Shape of the ground under every pixel of a level camera that looks down.
struct Terrain {
  cv::Mat slope_rad;  ///< CV_32FC1, angle between ground and horizontal
  cv::Mat
      roughness_rad;  ///< CV_32FC1, largest change of slope over the derivatives' baseline, along rows and along
                      ///< columns; empty where planes were fitted
  cv::Mat known;      ///< CV_8UC1, 255 where all exist: every depth they need is known and inside the image
  cv::Mat residual_m{};  ///< CV_32FC1, largest distance to the fitted plane; empty where none was
};

}  // namespace alight
