#pragma once

#include <string>

#include <opencv2/imgcodecs.hpp>

#include "foundation/errors.hpp"

namespace alight {

/// Writes an image in the format of the name's ending. @throws DataError naming the path
inline void write_picture(const std::string& path, const cv::Mat& picture) {
  bool written = false;
  try {
    written = cv::imwrite(path, picture);
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written) throw DataError(path + ": cannot be written; name a .png in a folder that exists");
}

}  // namespace alight
