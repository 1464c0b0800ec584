#include "accuracy/landing_rules.hpp"

#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "geometry/frames.hpp"
#include "geometry/reprojection.hpp"
#include "infer/landing/ground/elevation_raster.hpp"

namespace alight::bench {
namespace {

/// Shows every pixel of the level camera what its cell says.
cv::Mat shown(const cv::Mat& cells, const ElevationRaster& raster, const cv::Mat& level_depth_m,
              const PinholeIntrinsics& k, const Eigen::Isometry3d& T_world_camera,
              const Eigen::Matrix3d& R_level_camera) {
  const Eigen::Isometry3d T_world_level = level_pose(T_world_camera, R_level_camera);
  cv::Mat mask = cv::Mat::zeros(level_depth_m.size(), CV_8UC1);
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      const double z_m = static_cast<double>(level_depth_m.at<float>(v, u));
      if (z_m <= 0) continue;
      const Eigen::Vector3d p = T_world_level * (k.ray(u, v) * z_m);
      int column = 0;
      int row = 0;
      if (raster.cell_at(p.x(), p.y(), column, row))
        mask.at<std::uint8_t>(v, u) = cells.at<std::uint8_t>(row, column);
    }
  }
  return mask;
}

struct Spread {
  cv::Mat count;
  cv::Mat deviation_m;
};

Spread spread_of(const ElevationRaster& raster, const cv::Mat& depth_m, const PinholeIntrinsics& k,
                 const Eigen::Isometry3d& T_world_camera) {
  cv::Mat count = cv::Mat::zeros(raster.size(), CV_32FC1);
  cv::Mat squares = cv::Mat::zeros(raster.size(), CV_32FC1);
  for (int v = 0; v < depth_m.rows; ++v) {
    for (int u = 0; u < depth_m.cols; ++u) {
      const double z_m = static_cast<double>(depth_m.at<float>(v, u));
      if (z_m <= 0) continue;
      const Eigen::Vector3d p = T_world_camera * (k.ray(u, v) * z_m);
      int column = 0;
      int row = 0;
      if (!raster.cell_at(p.x(), p.y(), column, row)) continue;
      const float off = static_cast<float>(p.z()) - raster.mean_m.at<float>(row, column);
      count.at<float>(row, column) += 1;
      squares.at<float>(row, column) += off * off;
    }
  }
  Spread spread{count, {}};
  cv::sqrt(squares / cv::max(count, 1.0), spread.deviation_m);
  return spread;
}

}  // namespace

cv::Mat px4_safe_mask(const cv::Mat& depth_m, const cv::Mat& level_depth_m,
                      const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_world_camera,
                      const Eigen::Matrix3d& R_level_camera) {
  constexpr double kCell_m = 0.25;
  constexpr float kMinPoints = 3;
  constexpr double kMaxDeviation_m = 0.2;
  constexpr float kMaxMeanDifference_m = 0.1F;
  constexpr int kSmoothing = 5;
  constexpr int kMinFlat = 70;
  constexpr int kMaxDiffering = 70;
  const ElevationRaster raster = rasterize(depth_m, intrinsics, T_world_camera, kCell_m, 60);
  if (raster.empty()) return cv::Mat::zeros(level_depth_m.size(), CV_8UC1);
  const Spread spread = spread_of(raster, depth_m, intrinsics, T_world_camera);
  const cv::Mat flat = (spread.count >= kMinPoints) & (spread.deviation_m <= kMaxDeviation_m);
  cv::Mat safe = cv::Mat::zeros(raster.size(), CV_8UC1);
  for (int row = 0; row < safe.rows; ++row) {
    for (int column = 0; column < safe.cols; ++column) {
      int flat_cells = 0;
      int differing = 0;
      const float own_m = raster.mean_m.at<float>(row, column);
      for (int r = row - kSmoothing; r <= row + kSmoothing; ++r) {
        for (int c = column - kSmoothing; c <= column + kSmoothing; ++c) {
          const bool inside = r >= 0 && c >= 0 && r < safe.rows && c < safe.cols;
          const bool known = inside && raster.known.at<std::uint8_t>(r, c) != 0;
          flat_cells += inside && flat.at<std::uint8_t>(r, c) != 0 ? 1 : 0;
          differing +=
              !known || std::abs(raster.mean_m.at<float>(r, c) - own_m) > kMaxMeanDifference_m ? 1 : 0;
        }
      }
      const bool known = raster.known.at<std::uint8_t>(row, column) != 0;
      if (known && flat_cells > kMinFlat && differing <= kMaxDiffering)
        safe.at<std::uint8_t>(row, column) = 255;
    }
  }
  return shown(safe, raster, level_depth_m, intrinsics, T_world_camera, R_level_camera);
}

cv::Mat halss_safe_mask(const cv::Mat& depth_m, const cv::Mat& level_depth_m,
                        const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_world_camera,
                        const Eigen::Matrix3d& R_level_camera, double max_slope_deg, double min_radius_m) {
  constexpr double kCell_m = 0.2;
  const ElevationRaster raster = rasterize(depth_m, intrinsics, T_world_camera, kCell_m, 60);
  if (raster.empty()) return cv::Mat::zeros(level_depth_m.size(), CV_8UC1);
  const double max_gradient = std::tan(to_radians(max_slope_deg));
  cv::Mat flat = cv::Mat::zeros(raster.size(), CV_8UC1);
  const auto height = [&](int row, int column, double& out_m) {
    if (raster.known.at<std::uint8_t>(row, column) == 0) return false;
    out_m = static_cast<double>(raster.mean_m.at<float>(row, column));
    return true;
  };
  for (int row = 1; row + 1 < flat.rows; ++row) {
    for (int column = 1; column + 1 < flat.cols; ++column) {
      double west = 0, east = 0, south = 0, north = 0, own = 0;
      const bool known = height(row, column, own) && height(row, column - 1, west) &&
                         height(row, column + 1, east) && height(row - 1, column, south) &&
                         height(row + 1, column, north);
      if (!known) continue;
      const double gradient = std::hypot(east - west, north - south) / (2 * kCell_m);
      if (gradient < max_gradient) flat.at<std::uint8_t>(row, column) = 255;
    }
  }
  cv::Mat safe = cv::Mat::zeros(raster.size(), CV_8UC1);
  cv::Mat left = flat.clone();
  constexpr int kMaxCircles = 40;
  for (int i = 0; i < kMaxCircles; ++i) {
    cv::Mat distance;
    cv::distanceTransform(left, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    double radius_cells = 0;
    cv::Point centre;
    cv::minMaxLoc(distance, nullptr, &radius_cells, nullptr, &centre);
    if (radius_cells * kCell_m < min_radius_m) break;
    const int radius = static_cast<int>(radius_cells);
    cv::circle(safe, centre, radius, cv::Scalar(255), cv::FILLED);
    cv::circle(left, centre, radius, cv::Scalar(0), cv::FILLED);
  }
  safe &= flat;
  return shown(safe, raster, level_depth_m, intrinsics, T_world_camera, R_level_camera);
}

}  // namespace alight::bench
