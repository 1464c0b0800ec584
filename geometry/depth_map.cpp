#include "geometry/depth_map.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <opencv2/imgproc.hpp>

#include "foundation/order_statistics.hpp"

namespace alight {

cv::Mat ray_lengths(const PinholeIntrinsics& intrinsics) {
  cv::Mat lengths(intrinsics.size(), CV_32FC1);
  for (int v = 0; v < lengths.rows; ++v) {
    for (int u = 0; u < lengths.cols; ++u) {
      lengths.at<float>(v, u) = static_cast<float>(intrinsics.ray(u, v).norm());
    }
  }
  return lengths;
}

cv::Mat plane_to_perspective(const cv::Mat& depth_m, const PinholeIntrinsics& intrinsics) {
  CV_Assert(depth_m.type() == CV_32FC1 && depth_m.size() == intrinsics.size());
  return depth_m.mul(ray_lengths(intrinsics));
}

cv::Mat perspective_to_plane(const cv::Mat& range_m, const PinholeIntrinsics& intrinsics) {
  CV_Assert(range_m.type() == CV_32FC1 && range_m.size() == intrinsics.size());
  cv::Mat depth_m;
  cv::divide(range_m, ray_lengths(intrinsics), depth_m);
  return depth_m;
}

cv::Mat fill_nearest(const cv::Mat& depth_m, const cv::Mat& region, double max_distance_px) {
  CV_Assert(depth_m.type() == CV_32FC1);
  CV_Assert(region.empty() || (region.type() == CV_8UC1 && region.size() == depth_m.size()));
  cv::Mat filled = cv::Mat::zeros(depth_m.size(), CV_32FC1);
  const cv::Mat missing = depth_m == 0;
  if (cv::countNonZero(missing) == static_cast<int>(depth_m.total())) return filled;
  cv::Mat distance_px;
  cv::Mat labels;  // each pixel carries the label of its nearest pixel with a depth
  cv::distanceTransform(missing, distance_px, labels, cv::DIST_L2, cv::DIST_MASK_5, cv::DIST_LABEL_PIXEL);
  std::vector<float> depth_of_label(depth_m.total() + 1, 0.0F);
  for (int v = 0; v < depth_m.rows; ++v) {
    for (int u = 0; u < depth_m.cols; ++u) {
      const float depth = depth_m.at<float>(v, u);
      if (depth != 0.0F) depth_of_label[static_cast<std::size_t>(labels.at<int>(v, u))] = depth;
    }
  }
  const auto farthest_px = static_cast<float>(max_distance_px);
  for (int v = 0; v < depth_m.rows; ++v) {
    for (int u = 0; u < depth_m.cols; ++u) {
      if (!region.empty() && region.at<std::uint8_t>(v, u) == 0) continue;
      if (distance_px.at<float>(v, u) > farthest_px) continue;
      filled.at<float>(v, u) = depth_of_label[static_cast<std::size_t>(labels.at<int>(v, u))];
    }
  }
  return filled;
}

std::vector<float> known_depths(const cv::Mat& depth_m) {
  std::vector<float> values;
  values.reserve(depth_m.total());
  for (int v = 0; v < depth_m.rows; ++v) {
    std::copy_if(depth_m.ptr<float>(v), depth_m.ptr<float>(v) + depth_m.cols, std::back_inserter(values),
                 [](float depth) { return depth > 0; });
  }
  return values;
}

std::optional<double> median_depth_m(const cv::Mat& depth_m) {
  std::vector<float> values = known_depths(depth_m);
  if (values.empty()) return std::nullopt;
  return static_cast<double>(median(values));
}

ColourRange colour_range(const cv::Mat& depth_m) {
  std::vector<float> values = known_depths(depth_m);
  if (values.empty()) return {};
  const std::size_t cut = values.size() / 100;
  const auto min_m = static_cast<double>(value_at_place(values, cut));
  return {min_m, std::max(static_cast<double>(value_at_place(values, values.size() - 1 - cut)), min_m + 0.1)};
}

cv::Mat colour_depth(const cv::Mat& depth_m, double min_m, double max_m) {
  CV_Assert(depth_m.type() == CV_32FC1);
  const cv::Mat known = depth_m > 0;
  if (max_m <= min_m) {
    const ColourRange range = colour_range(depth_m);
    min_m = range.min_m;
    max_m = range.max_m;
  }
  cv::Mat grey;
  const double scale = 255.0 / (max_m - min_m);
  depth_m.convertTo(grey, CV_8UC1, -scale, 255.0 + scale * min_m);  // near is bright, which turbo paints red
  cv::Mat colours;
  cv::applyColorMap(grey, colours, cv::COLORMAP_TURBO);
  colours.setTo(cv::Scalar::all(0), ~known);
  return colours;
}

cv::Mat encode_depth(const cv::Mat& depth_m) {
  CV_Assert(depth_m.type() == CV_32FC1);
  cv::Mat encoded;
  depth_m.convertTo(encoded, CV_16UC1, 256.0);
  return encoded;
}

cv::Mat decode_depth(const cv::Mat& depth_16) {
  CV_Assert(depth_16.type() == CV_16UC1);
  cv::Mat depth_m;
  depth_16.convertTo(depth_m, CV_32FC1, 1.0 / 256.0);
  return depth_m;
}

}  // namespace alight
