#pragma once

#include <opencv2/core.hpp>

#include "calibrate/clocks/clock_alignment.hpp"

namespace alight {

/// The score over each clock's offset with the offset that was found, and below how images and poses turned once the camera's
/// offset is put right. CV_8UC3
cv::Mat draw_clock_alignment(const ClockAlignment& alignment);

}  // namespace alight
