#pragma once

#include <filesystem>
#include <optional>

#include <opencv2/core.hpp>

namespace alight {

/// Writes an image in the format of the name's ending.
/// @param picture of a type that the format can hold: 8 bits for all, 16 bits for PNG, float for TIFF
/// @param png_compression 0 (none, quick) to 9; empty: OpenCV's own choice. Other formats do without.
/// @throws DataError naming the path, what may be wrong and, where OpenCV has one, its reason
void write_picture(const std::filesystem::path& path, const cv::Mat& picture,
                   std::optional<int> png_compression = std::nullopt);

}  // namespace alight
