#pragma once

#include <cstddef>
#include <cstdint>

#include <opencv2/core.hpp>

namespace alight {

/// True for what begins like a JPEG.
bool is_jpeg(const std::uint8_t* data, std::size_t size);

/// CV_8UC1 of a grey JPEG, else CV_8UC3 BGR: the pixels that cv::imdecode gives, in half its time (OpenCV decodes to RGB and
/// swaps), but damaged data is an error where OpenCV goes on with grey blocks.
/// @throws DecodeError damaged, of no use to a camera (CMYK), or larger than `max_side_px`
cv::Mat decode_jpeg(const std::uint8_t* data, std::size_t size, int max_side_px);

}  // namespace alight
