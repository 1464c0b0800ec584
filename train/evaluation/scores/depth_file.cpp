#include "train/evaluation/scores/depth_file.hpp"

#include <cstdlib>
#include <limits>

#include <opencv2/imgcodecs.hpp>

#include "foundation/errors.hpp"
#include "geometry/depth_map.hpp"

namespace alight {
namespace {

cv::Mat read_file(const std::filesystem::path& path, int flags) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code))
    throw DataError(path.string() + ": there is no such file");
  cv::Mat image;
  try {
    image = cv::imread(path.string(), flags);
  } catch (const cv::Exception& e) {
    throw DataError(path.string() + ": cannot be read: " + e.err);
  }
  if (image.empty()) throw DataError(path.string() + ": is no image that OpenCV can read");
  return image;
}

}  // namespace

cv::Mat read_depth_file(const std::filesystem::path& path) {
  setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 0);  // OpenCV leaves EXR off unless asked
  const cv::Mat stored = read_file(path, cv::IMREAD_UNCHANGED);
  if (stored.type() == CV_16UC1) return decode_depth(stored);
  if (stored.type() != CV_32FC1) {
    throw DataError(path.string() +
                    ": is no depth map; expected one channel of 16-bit PNG in 1/256 m, or of 32-bit "
                    "TIFF or EXR in metres");
  }
  const cv::Mat usable = (stored > 0) & (stored <= std::numeric_limits<float>::max());  // false for NaN
  cv::Mat depth_m = cv::Mat::zeros(stored.size(), CV_32FC1);
  stored.copyTo(depth_m, usable);
  return depth_m;
}

cv::Mat read_image_file(const std::filesystem::path& path) {
  return read_file(path, cv::IMREAD_ANYCOLOR);  // 8 bit, grey or BGR
}

}  // namespace alight
