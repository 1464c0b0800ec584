#include "geometry/crop.hpp"

#include <stdexcept>

namespace alight {

cv::Rect centre_crop(cv::Size image, cv::Size size) {
  if (size.width <= 0 || size.height <= 0 || size.width > image.width || size.height > image.height) {
    throw std::invalid_argument("centre_crop: " + std::to_string(size.width) + "x" +
                                std::to_string(size.height) + " does not fit into " +
                                std::to_string(image.width) + "x" + std::to_string(image.height));
  }
  return {(image.width - size.width) / 2, (image.height - size.height) / 2, size.width, size.height};
}

PinholeIntrinsics crop(const PinholeIntrinsics& intrinsics, const cv::Rect& rect) {
  PinholeIntrinsics cropped = intrinsics;
  cropped.cx_px -= rect.x;
  cropped.cy_px -= rect.y;
  cropped.width_px = rect.width;
  cropped.height_px = rect.height;
  return cropped;
}

}  // namespace alight
