#include "geometry/reprojection.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "geometry/wide_loops.hpp"

namespace alight {
namespace {

/// Where the rays first + u * step of a row of target pixels meet the source image; column -1 where they do not.
ALIGHT_WIDE_LOOPS void source_pixels(int width, const double (&first)[3], const double (&step)[3],
                                     const PinholeIntrinsics& k, int* __restrict column,
                                     int* __restrict row) {
  const double x0 = first[0], y0 = first[1], z0 = first[2];
  const double dx = step[0], dy = step[1], dz = step[2];
  const double fx = k.fx_px, fy = k.fy_px, cx = k.cx_px, cy = k.cy_px;
  const double right = k.width_px - 0.5, bottom = k.height_px - 0.5;
  for (int u = 0; u < width; ++u) {
    const double z = z0 + u * dz;
    const double u_px = fx * (x0 + u * dx) / z + cx;
    const double v_px = fy * (y0 + u * dy) / z + cy;
    // PinholeIntrinsics::contains
    const bool inside = z > 0 && u_px >= -0.5 && v_px >= -0.5 && u_px < right && v_px < bottom;
    column[u] = static_cast<int>(inside ? u_px + 0.5 : -1.0);
    row[u] = static_cast<int>(inside ? v_px + 0.5 : 0.0);
  }
}

}  // namespace

cv::Mat reproject_depth(const cv::Mat& depth_source_m, const PinholeIntrinsics& intrinsics_source,
                        const Eigen::Isometry3d& T_target_source,
                        const PinholeIntrinsics& intrinsics_target) {
  CV_Assert(depth_source_m.type() == CV_32FC1 && depth_source_m.size() == intrinsics_source.size());
  cv::Mat depth_target_m = cv::Mat::zeros(intrinsics_target.size(), CV_32FC1);
  const Eigen::Matrix3d R = T_target_source.linear();
  const Eigen::Vector3d t = T_target_source.translation();
  for (int v = 0; v < depth_source_m.rows; ++v) {
    const float* depth_row = depth_source_m.ptr<float>(v);
    for (int u = 0; u < depth_source_m.cols; ++u) {
      if (!(depth_row[u] > 0)) continue;
      const Eigen::Vector3d p_target = R * (depth_row[u] * intrinsics_source.ray(u, v)) + t;
      if (p_target.z() <= 0) continue;
      const Eigen::Vector2d pixel = intrinsics_target.project(p_target);
      if (!intrinsics_target.contains(pixel.x(), pixel.y())) continue;
      float& held =
          depth_target_m.at<float>(static_cast<int>(pixel.y() + 0.5), static_cast<int>(pixel.x() + 0.5));
      const float depth = static_cast<float>(p_target.z());
      if (held == 0.0F || depth < held) held = depth;
    }
  }
  return depth_target_m;
}

SampledView sample_view(const cv::Mat& image_source, const PinholeIntrinsics& intrinsics_source,
                        const cv::Mat& depth_target_m, const PinholeIntrinsics& intrinsics_target,
                        const Eigen::Isometry3d& T_source_target) {
  CV_Assert(image_source.size() == intrinsics_source.size());
  CV_Assert(depth_target_m.type() == CV_32FC1 && depth_target_m.size() == intrinsics_target.size());
  const Eigen::Matrix3d R = T_source_target.linear();
  const Eigen::Vector3d t = T_source_target.translation();
  cv::Mat map(depth_target_m.size(), CV_32FC2, cv::Scalar::all(-10));
  SampledView view;
  view.valid = cv::Mat::zeros(depth_target_m.size(), CV_8UC1);
  for (int v = 0; v < map.rows; ++v) {
    for (int u = 0; u < map.cols; ++u) {
      const float depth = depth_target_m.at<float>(v, u);
      if (!(depth > 0)) continue;
      const Eigen::Vector3d p_source = R * (depth * intrinsics_target.ray(u, v)) + t;
      if (p_source.z() <= 0) continue;
      const Eigen::Vector2d pixel = intrinsics_source.project(p_source);
      // All four neighbours of the bilinear sample have to exist.
      const bool inside = pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= intrinsics_source.width_px - 1 &&
                          pixel.y() <= intrinsics_source.height_px - 1;
      if (!inside) continue;
      map.at<cv::Vec2f>(v, u) = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
      view.valid.at<std::uint8_t>(v, u) = 255;
    }
  }
  cv::remap(image_source, view.image, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return view;
}

cv::Mat rotate_depth(const cv::Mat& depth_source_m, const PinholeIntrinsics& intrinsics,
                     const Eigen::Matrix3d& R_target_source) {
  CV_Assert(depth_source_m.type() == CV_32FC1 && depth_source_m.size() == intrinsics.size());
  const Eigen::Matrix3d R_source_target = R_target_source.transpose();
  // A row's rays differ by one step, and what a source ray's depth becomes by one step a column and a row.
  const Eigen::Vector3d step = R_source_target.col(0) / intrinsics.fx_px;
  const Eigen::Vector3d down = R_target_source.row(2);
  const double down_u = down.x() / intrinsics.fx_px;
  const double down_v = down.y() / intrinsics.fy_px;
  const double down_0 = down.dot(intrinsics.ray(0, 0));
  cv::Mat depth_target_m = cv::Mat::zeros(intrinsics.size(), CV_32FC1);
  std::vector<int> column(static_cast<std::size_t>(intrinsics.width_px));
  std::vector<int> row(column.size());
  for (int v = 0; v < depth_target_m.rows; ++v) {
    const Eigen::Vector3d first = R_source_target * intrinsics.ray(0, v);
    source_pixels(depth_target_m.cols, {first.x(), first.y(), first.z()}, {step.x(), step.y(), step.z()},
                  intrinsics, column.data(), row.data());
    auto* const target = depth_target_m.ptr<float>(v);
    for (std::size_t u = 0; u < column.size(); ++u) {
      if (column[u] < 0) continue;
      // The depth of the measured point itself: the target ray passes half a pixel beside it, and on a tilted view
      // that would be centimetres of height.
      const double z_target = (down_0 + down_u * column[u] + down_v * row[u]) *
                              static_cast<double>(depth_source_m.ptr<float>(row[u])[column[u]]);
      target[u] = static_cast<float>(std::max(z_target, 0.0));
    }
  }
  return depth_target_m;
}

Eigen::Matrix3d level_rotation(const Eigen::Matrix3d& R_world_camera) {
  const Eigen::Vector3d z_level = -Eigen::Vector3d::UnitZ();  // optical axis straight down
  Eigen::Vector3d x_level = R_world_camera.col(0);
  x_level.z() = 0;  // the image's right, laid into the horizontal plane, keeps the yaw
  if (x_level.norm() < 1e-6)
    throw std::invalid_argument("level_rotation: the image's right points straight up or down");
  x_level.normalize();
  Eigen::Matrix3d R_world_level;
  R_world_level << x_level, z_level.cross(x_level), z_level;
  return R_world_level.transpose() * R_world_camera;
}

Eigen::Isometry3d level_pose(const Eigen::Isometry3d& T_world_camera, const Eigen::Matrix3d& R_level_camera) {
  Eigen::Isometry3d T_world_level = T_world_camera;
  T_world_level.linear() = T_world_camera.linear() * R_level_camera.transpose();
  return T_world_level;
}

}  // namespace alight
