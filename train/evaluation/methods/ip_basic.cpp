#include "train/evaluation/methods/ip_basic.hpp"

#include <algorithm>
#include <cstdlib>

#include <opencv2/imgproc.hpp>

#include "geometry/depth_map.hpp"

namespace alight {
namespace {

constexpr double kMargin_m = 1;  // an inverted depth stays this far above 0, which stands for empty

cv::Mat square(int side) { return cv::Mat::ones(side, side, CV_8UC1); }

cv::Mat diamond(int side) {
  cv::Mat kernel = cv::Mat::zeros(side, side, CV_8UC1);
  const int centre = side / 2;
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      if (std::abs(v - centre) + std::abs(u - centre) <= centre) kernel.at<std::uint8_t>(v, u) = 1;
    }
  }
  return kernel;
}

void fill_holes(cv::Mat& inverted, const cv::Mat& kernel) {
  cv::Mat dilated;
  cv::dilate(inverted, dilated, kernel);
  dilated.copyTo(inverted, inverted == 0);
}

}  // namespace

cv::Mat fill_ip_basic(const cv::Mat& sparse_m, double range_m) {
  CV_Assert(sparse_m.type() == CV_32FC1);
  const cv::Mat known = sparse_m > 0;
  if (cv::countNonZero(known) == 0) return cv::Mat::zeros(sparse_m.size(), CV_32FC1);
  double farthest_m = 0;
  cv::minMaxLoc(sparse_m, nullptr, &farthest_m);
  const double offset_m = std::max(range_m, farthest_m + kMargin_m);

  cv::Mat inverted = cv::Mat::zeros(sparse_m.size(), CV_32FC1);
  cv::Mat(offset_m - sparse_m).copyTo(inverted, known);
  cv::dilate(inverted, inverted, diamond(5));
  cv::morphologyEx(inverted, inverted, cv::MORPH_CLOSE, square(5));
  fill_holes(inverted, square(7));
  fill_holes(inverted, square(31));
  inverted = fill_nearest(inverted);
  cv::medianBlur(inverted, inverted, 5);
  cv::GaussianBlur(inverted, inverted, {5, 5}, 0);
  return offset_m - inverted;
}

}  // namespace alight
