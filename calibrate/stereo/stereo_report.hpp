#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "calibrate/stereo/stereo_calibration.hpp"

namespace alight {

/// The result for a reader.
std::string format_stereo_report(const StereoCalibration& calibration);

/// Both rectified images of a view side by side with level lines through both. CV_8UC3
cv::Mat draw_rectified(const StereoCalibration& calibration, const StereoView& view);

}  // namespace alight
