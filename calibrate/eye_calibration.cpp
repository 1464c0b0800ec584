#include "calibrate/eye_calibration.hpp"

#include <opencv2/calib3d.hpp>

#include "calibrate/opencv_pose.hpp"

namespace alight {
namespace {

Camera camera_of(const cv::Mat& K, const cv::Mat& D, cv::Size size, DistortionModel model) {
  Camera camera;
  camera.intrinsics = {K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2),
                       K.at<double>(1, 2), size.width,         size.height};
  camera.distortion_model = model;
  for (int i = 0; i < static_cast<int>(D.total()); ++i) camera.distortion_coeffs.push_back(D.at<double>(i));
  return camera;
}

}  // namespace

Eye calibrate_eye(const Chessboard& board, const std::vector<Corners>& corners, cv::Size size,
                  const StereoCalibrationConfig& config) {
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  cv::Mat K;
  cv::Mat D;
  if (config.model == DistortionModel::kEquidistant) {
    std::vector<std::vector<cv::Point3d>> points;
    std::vector<std::vector<cv::Point2d>> pixels;
    for (const Corners& view : corners) {
      std::vector<cv::Point3d> p;
      for (const cv::Point3f& corner : board.corner_points()) p.emplace_back(corner);
      points.push_back(p);
      pixels.emplace_back(view.begin(), view.end());
    }
    cv::fisheye::calibrate(points, pixels, size, K, D, rotations, translations,
                           cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW);
  } else {
    const std::vector<std::vector<cv::Point3f>> points(corners.size(), board.corner_points());
    cv::calibrateCamera(points, corners, size, K, D, rotations, translations,
                        config.radtan_coefficients == 4 ? cv::CALIB_FIX_K3 : 0);
    D = D.reshape(1, 1).colRange(0, config.radtan_coefficients).clone();
  }
  Eye eye{camera_of(K, D, size, config.model), {}};
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    eye.T_camera_board.push_back(isometry_of(rotations[i], translations[i]));
  }
  return eye;
}

}  // namespace alight
