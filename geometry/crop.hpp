#pragma once

#include <opencv2/core.hpp>

#include "geometry/camera.hpp"

namespace alight {

/// The centred rectangle of `size` in an image of `image`. @throws std::invalid_argument if it does not fit
cv::Rect centre_crop(cv::Size image, cv::Size size);

/// Intrinsics of the cropped image: the principal point moves along.
PinholeIntrinsics crop(const PinholeIntrinsics& intrinsics, const cv::Rect& rect);

}  // namespace alight
