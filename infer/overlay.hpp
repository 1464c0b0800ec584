#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "infer/landing_pipeline.hpp"

namespace alight {

/// A picture with a title.
struct Panel {
  std::string title;
  cv::Mat image;  ///< CV_8UC3 BGR
};

/// Panels of one size side by side, each under its title. @returns CV_8UC3
cv::Mat panel_strip(const std::vector<Panel>& panels);

/// image | depth in colour | safe ground, seen level | landing site. The image must have been opened
/// (frame.depth.left not empty); missing parts are black and say so.
cv::Mat replay_strip(const FrameReport& frame);

/// image | sparse depth | completed depth | landing site: the method in one picture.
cv::Mat method_strip(const FrameReport& frame);

}  // namespace alight
