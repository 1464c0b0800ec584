#pragma once

#include <filesystem>

#include <opencv2/core.hpp>

#include "foundation/errors.hpp"

namespace alight {

/// A depth map of any program: 16-bit PNG in 1/256 m (KITTI's convention), or 32-bit TIFF or EXR in metres. What is not
/// a positive finite number is missing. @returns CV_32FC1 plane depth in metres, 0 = missing
/// @throws DataError if the file is missing, unreadable or holds another kind of pixels
cv::Mat read_depth_file(const std::filesystem::path& path);

/// As it is in the file, CV_8UC1 or CV_8UC3 BGR. @throws DataError
cv::Mat read_image_file(const std::filesystem::path& path);

}  // namespace alight
