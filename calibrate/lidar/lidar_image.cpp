#include "calibrate/lidar/lidar_image.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "foundation/order_statistics.hpp"
#include "geometry/depth_map.hpp"

namespace alight {
namespace {

constexpr double kMaxHalfFov_rad = 0.7;  // a virtual plane cannot take much more
constexpr double kWhiteLevel = 150;      // Livox: above are retro-reflectors

/// Half the angle that all but a thousandth of the points lie in.
double half_fov(const std::vector<LidarReturn>& points) {
  std::vector<float> cosines;
  cosines.reserve(points.size());
  for (const LidarReturn& point : points) cosines.push_back(point.p_lidar.x() / point.p_lidar.norm());
  if (cosines.empty()) return 0.1;
  const auto cut = static_cast<double>(value_at_place(cosines, cosines.size() / 1000));
  return std::clamp(std::acos(cut), 0.05, kMaxHalfFov_rad);
}

}  // namespace

Eigen::Matrix3d R_virtual_lidar() {
  Eigen::Matrix3d R;
  R << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return R;
}

Eigen::Vector3d LidarImage::ray(const cv::Point2f& pixel) const {
  return R_virtual_lidar().transpose() *
         intrinsics.ray(static_cast<double>(pixel.x), static_cast<double>(pixel.y)).normalized();
}

Eigen::Vector2d LidarImage::project(const Eigen::Vector3d& p_lidar) const {
  return intrinsics.project(R_virtual_lidar() * p_lidar);
}

LidarImage draw_lidar_image(const std::vector<LidarReturn>& points, double focal_px) {
  constexpr int kMargin_px = 4;
  LidarImage image;
  const int half = static_cast<int>(std::ceil(focal_px * std::tan(half_fov(points)))) + kMargin_px;
  image.intrinsics = {focal_px,     focal_px,    static_cast<double>(half), static_cast<double>(half),
                      2 * half + 1, 2 * half + 1};
  cv::Mat sum = cv::Mat::zeros(image.intrinsics.size(), CV_32FC1);
  cv::Mat count = cv::Mat::zeros(image.intrinsics.size(), CV_32FC1);
  for (const LidarReturn& point : points) {
    if (point.p_lidar.x() <= 0) continue;
    const Eigen::Vector2d pixel = image.project(point.p_lidar.cast<double>());
    if (!image.intrinsics.contains(pixel.x(), pixel.y())) continue;
    const cv::Point at(static_cast<int>(std::lround(pixel.x())), static_cast<int>(std::lround(pixel.y())));
    sum.at<float>(at) += point.reflectivity;
    count.at<float>(at) += 1;
  }
  image.seen = count > 0;
  cv::Mat mean = cv::Mat::zeros(sum.size(), CV_32FC1);
  // One level up, because fill_nearest reads 0 as missing and black is a reflectivity.
  for (int v = 0; v < mean.rows; ++v) {
    for (int u = 0; u < mean.cols; ++u) {
      const float points_here = count.at<float>(v, u);
      if (points_here > 0) mean.at<float>(v, u) = 1.0F + sum.at<float>(v, u) / points_here;
    }
  }
  const cv::Mat filled = fill_nearest(mean);
  filled.convertTo(image.reflectivity, CV_8UC1, 255 / kWhiteLevel, -255 / kWhiteLevel);
  return image;
}

}  // namespace alight
