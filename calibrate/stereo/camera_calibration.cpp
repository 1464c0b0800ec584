#include "calibrate/stereo/camera_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <opencv2/calib3d.hpp>

#include "calibrate/fitting/opencv_pose.hpp"
#include "foundation/errors.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

CameraStart calibrate_radtan(const Chessboard& board, const std::vector<Corners>& corners, cv::Size size,
                             int coefficients) {
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  cv::Mat K;
  cv::Mat D;
  const std::vector<std::vector<cv::Point3f>> points(corners.size(), board.corner_points());
  cv::calibrateCamera(points, corners, size, K, D, rotations, translations,
                      coefficients == 4 ? cv::CALIB_FIX_K3 : 0);
  CameraStart start;
  start.camera.intrinsics = {K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2),
                             K.at<double>(1, 2), size.width,         size.height};
  start.camera.distortion_model = DistortionModel::kRadtan;
  for (int i = 0; i < coefficients; ++i) start.camera.distortion_coeffs.push_back(D.at<double>(i));
  for (std::size_t i = 0; i < rotations.size(); ++i)
    start.T_camera_board.push_back(isometry_of(rotations[i], translations[i]));
  return start;
}

/// The directions of the corners through an ideal fisheye (r = f theta); empty if one is beyond the model's 90 deg.
std::vector<Vector3d> fisheye_rays(const Corners& corners, const PinholeIntrinsics& intrinsics) {
  std::vector<Vector3d> rays;
  for (const cv::Point2f& corner : corners) {
    const Vector2d off((static_cast<double>(corner.x) - intrinsics.cx_px) / intrinsics.fx_px,
                       (static_cast<double>(corner.y) - intrinsics.cy_px) / intrinsics.fy_px);
    const double theta = off.norm();
    if (theta >= kPi / 2) return {};
    const Vector2d side = theta < 1e-9 ? off : Vector2d(off * (std::sin(theta) / theta));
    rays.emplace_back(side.x(), side.y(), std::cos(theta));
  }
  return rays;
}

/// Pose of a board from the directions of its corners, wherever they point to: a camera that turns its axis to them
/// sees the board as a pinhole would.
std::optional<Eigen::Isometry3d> board_pose(const Chessboard& board, const std::vector<Vector3d>& rays) {
  Vector3d axis = Vector3d::Zero();
  for (const Vector3d& ray : rays) axis += ray;
  const auto turn = Eigen::Quaterniond::FromTwoVectors(axis, Vector3d::UnitZ());
  std::vector<cv::Point2d> points;
  for (const Vector3d& ray : rays) {
    const Vector3d turned = turn * ray;
    if (turned.z() <= 0) return std::nullopt;
    points.emplace_back(turned.x() / turned.z(), turned.y() / turned.z());
  }
  cv::Mat rotation;
  cv::Mat translation;
  if (!cv::solvePnP(board.corner_points(), points, cv::Matx33d::eye(), cv::noArray(), rotation, translation,
                    false, cv::SOLVEPNP_IPPE))
    return std::nullopt;
  const Eigen::Isometry3d T = Eigen::Isometry3d(turn.inverse()) * isometry_of(rotation, translation);
  return T.matrix().allFinite() ? std::optional<Eigen::Isometry3d>(T) : std::nullopt;
}

/// Sum of squared angles between the corners' directions and the board's corners.
double squared_angles(const Chessboard& board, const std::vector<Vector3d>& rays,
                      const Eigen::Isometry3d& T) {
  double sum = 0;
  for (int i = 0; i < board.corners(); ++i) {
    const Vector3d seen = (T * board.corner(i)).normalized();
    sum += std::pow(2 * std::asin(0.5 * (seen - rays[static_cast<std::size_t>(i)]).norm()), 2);
  }
  return sum;
}

/// The ideal fisheye that explains the boards best, of focal lengths 10 % apart: near enough for the refinement that
/// follows. cv::fisheye::calibrate is not used: its undamped steps diverge on one good set in eight.
CameraStart start_fisheye(const Chessboard& board, const std::vector<Corners>& corners, cv::Size size) {
  const double right_angle_px =
      0.5 * std::hypot(size.width, size.height) / (kPi / 2);  // to the image's corner
  CameraStart best;
  double best_px2 = std::numeric_limits<double>::infinity();
  for (double f_px = right_angle_px / 2; f_px < 20 * right_angle_px; f_px *= 1.1) {
    CameraStart start;
    start.camera.intrinsics = {f_px,       f_px,       0.5 * (size.width - 1), 0.5 * (size.height - 1),
                               size.width, size.height};
    double px2 = 0;
    for (const Corners& view : corners) {
      const std::vector<Vector3d> rays = fisheye_rays(view, start.camera.intrinsics);
      const std::optional<Eigen::Isometry3d> T = rays.empty() ? std::nullopt : board_pose(board, rays);
      if (!T) break;
      px2 += f_px * f_px * squared_angles(board, rays, *T);
      start.T_camera_board.push_back(*T);
    }
    if (start.T_camera_board.size() < corners.size() || px2 >= best_px2) continue;
    best_px2 = px2;
    best = start;
  }
  if (best.T_camera_board.empty())
    throw DataError(
        "no fisheye explains the boards' corners: are they from one camera, and is the lens one?");
  best.camera.distortion_model = DistortionModel::kEquidistant;
  best.camera.distortion_coeffs = {0, 0, 0, 0};
  return best;
}

}  // namespace

CameraStart calibrate_camera(const Chessboard& board, const std::vector<Corners>& corners, cv::Size size,
                             const StereoCalibrationConfig& config) {
  return config.model == DistortionModel::kEquidistant
             ? start_fisheye(board, corners, size)
             : calibrate_radtan(board, corners, size, config.radtan_coefficients);
}

}  // namespace alight
