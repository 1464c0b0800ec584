#include "geometry/camera.hpp"

#include <algorithm>

#include <opencv2/calib3d.hpp>

namespace alight {

bool operator==(const PinholeIntrinsics& a, const PinholeIntrinsics& b) {
  return a.fx_px == b.fx_px && a.fy_px == b.fy_px && a.cx_px == b.cx_px && a.cy_px == b.cy_px &&
         a.width_px == b.width_px && a.height_px == b.height_px;
}

bool Camera::has_distortion() const {
  if (distortion_model == DistortionModel::kEquidistant)
    return true;  // r = f theta, even without coefficients
  return distortion_model == DistortionModel::kRadtan &&
         std::any_of(distortion_coeffs.begin(), distortion_coeffs.end(), [](double k) { return k != 0; });
}

std::optional<Eigen::Vector2d> Camera::project(const Eigen::Vector3d& p_camera) const {
  if (p_camera.z() <= 0) return std::nullopt;
  if (!has_distortion()) return intrinsics.project(p_camera);
  const std::vector<cv::Point3d> points = {{p_camera.x(), p_camera.y(), p_camera.z()}};
  std::vector<cv::Point2d> pixels;
  const cv::Vec3d zero(0, 0, 0);
  if (distortion_model == DistortionModel::kRadtan) {
    cv::projectPoints(points, zero, zero, intrinsics.matrix(), distortion_coeffs, pixels);
  } else {
    cv::fisheye::projectPoints(points, pixels, zero, zero, intrinsics.matrix(), distortion_coeffs);
  }
  return Eigen::Vector2d(pixels[0].x, pixels[0].y);
}

Eigen::Vector3d Camera::unproject(const Eigen::Vector2d& pixel) const {
  if (!has_distortion()) return intrinsics.ray(pixel.x(), pixel.y());
  const std::vector<cv::Point2d> pixels = {{pixel.x(), pixel.y()}};
  std::vector<cv::Point2d> normalised;
  // OpenCV's default of five iterations leaves hundredths of a pixel at the rim.
  const cv::TermCriteria criteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 100, 1e-12);
  if (distortion_model == DistortionModel::kRadtan) {
    cv::undistortPoints(pixels, normalised, intrinsics.matrix(), distortion_coeffs, cv::noArray(),
                        cv::noArray(), criteria);
  } else {
    cv::fisheye::undistortPoints(pixels, normalised, intrinsics.matrix(), distortion_coeffs);
  }
  return {normalised[0].x, normalised[0].y, 1.0};
}

}  // namespace alight
