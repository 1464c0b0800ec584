#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace alight {

/// Undistorted pinhole camera. Pixel (0, 0) is the centre of the top left pixel.
struct PinholeIntrinsics {
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;
  double cy_px = 0;
  int width_px = 0;
  int height_px = 0;

  cv::Size size() const { return {width_px, height_px}; }
  cv::Matx33d matrix() const { return {fx_px, 0, cx_px, 0, fy_px, cy_px, 0, 0, 1}; }

  /// Pixel of a point in camera coordinates; the point's z must be positive.
  Eigen::Vector2d project(const Eigen::Vector3d& p_camera) const {
    return {fx_px * p_camera.x() / p_camera.z() + cx_px, fy_px * p_camera.y() / p_camera.z() + cy_px};
  }
  /// Viewing ray of a pixel, scaled to z = 1: times the plane depth it is the point.
  Eigen::Vector3d ray(double u_px, double v_px) const {
    return {(u_px - cx_px) / fx_px, (v_px - cy_px) / fy_px, 1.0};
  }
  bool contains(double u_px, double v_px) const {
    return u_px >= -0.5 && v_px >= -0.5 && u_px < width_px - 0.5 && v_px < height_px - 0.5;
  }
};

bool operator==(const PinholeIntrinsics& a, const PinholeIntrinsics& b);

/// Kalibr's names. radtan: OpenCV's k1 k2 p1 p2 [k3 [k4 k5 k6]]; equidistant: Kannala-Brandt k1..k4
/// (cv::fisheye).
enum class DistortionModel { kNone, kRadtan, kEquidistant };

/// A real lens: pinhole and distortion.
struct Camera {
  PinholeIntrinsics intrinsics;
  DistortionModel distortion_model = DistortionModel::kNone;
  std::vector<double> distortion_coeffs;

  /// Distorted pixel of a point in camera coordinates; empty behind the camera.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_camera) const;
  /// Viewing ray of a distorted pixel, scaled to z = 1.
  Eigen::Vector3d unproject(const Eigen::Vector2d& pixel) const;
  bool has_distortion() const;
};

}  // namespace alight
