#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "dataset/store/sample_store.hpp"

namespace alight {

/// A sample for the camera, labelled panels side by side: the image, the depth over it, the time offsets in
/// colour and, where it was read, the true depth. Both depths share one colour scale. @returns BGR CV_8UC3
cv::Mat draw_sample(const Sample& sample, const std::string& title);

}  // namespace alight
