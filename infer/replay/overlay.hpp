#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "infer/depth/landing_pipeline.hpp"

namespace alight {

/// A picture with a title.
struct Panel {
  std::string title;
  cv::Mat image;  ///< CV_8UC3 BGR
};

/// Panels of one size side by side, each under its title. @returns CV_8UC3
cv::Mat panel_strip(const std::vector<Panel>& panels);

/// Metres at the ends of a colour scale; both 0 where there is no depth.
struct ColourScale {
  double min_m = 0;
  double max_m = 0;
};
/// Of the known pixels of a CV_32FC1 depth map, 0 = unknown.
ColourScale colour_scale(const cv::Mat& depth_m);

/// The left image with the landing circle: green once the site is accepted, orange before. CV_8UC3; like all pictures
/// below it needs an image that was opened (frame.depth.left not empty).
cv::Mat site_picture(const FrameReport& frame);

/// Depth in colour over colour_scale of it: predicted pixels plain, interpolated ones hatched, unknown ones black. CV_8UC3
cv::Mat depth_picture(const FrameReport& frame);

/// Safe ground seen by the level camera, with the landing circle: green safe, red not, grey unknown. CV_8UC3
cv::Mat safe_picture(const FrameReport& frame);

/// image | depth in colour | safe ground, seen level | landing site. The image must have been opened
/// (frame.depth.left not empty); missing parts are black and say so.
cv::Mat replay_strip(const FrameReport& frame);

/// image | sparse depth | completed depth | landing site: the method in one picture.
cv::Mat method_strip(const FrameReport& frame);

}  // namespace alight
