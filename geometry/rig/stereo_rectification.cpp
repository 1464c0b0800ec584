#include "geometry/rig/stereo_rectification.hpp"

#include <cmath>
#include <stdexcept>

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include "geometry/crop.hpp"

namespace alight {
namespace {

bool is_rectified(const Rig& rig) {
  if (rig.cam0.camera.has_distortion()) return false;
  if (!rig.cam1) return true;
  const Eigen::Vector3d t = rig.T_cam1_cam0.translation();
  const bool same_camera = rig.cam0.camera.intrinsics == rig.cam1->camera.intrinsics;
  const bool parallel = (rig.T_cam1_cam0.linear() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-9;
  return same_camera && !rig.cam1->camera.has_distortion() && parallel && std::abs(t.y()) < 1e-9 &&
         std::abs(t.z()) < 1e-9;
}

PinholeIntrinsics intrinsics_of(const cv::Mat& projection, cv::Size size) {
  return {projection.at<double>(0, 0),
          projection.at<double>(1, 1),
          projection.at<double>(0, 2),
          projection.at<double>(1, 2),
          size.width,
          size.height};
}

/// Pixel map of one camera: where in the raw image each rectified pixel comes from. CV_32FC2
cv::Mat rectification_map(const Camera& camera, const cv::Mat& R_rectified_camera,
                          const PinholeIntrinsics& rectified) {
  cv::Mat map_u;
  cv::Mat map_v;
  if (camera.distortion_model == DistortionModel::kEquidistant) {
    cv::fisheye::initUndistortRectifyMap(camera.intrinsics.matrix(), camera.distortion_coeffs,
                                         R_rectified_camera, rectified.matrix(), rectified.size(), CV_32FC1,
                                         map_u, map_v);
  } else {
    cv::initUndistortRectifyMap(camera.intrinsics.matrix(), camera.distortion_coeffs, R_rectified_camera,
                                rectified.matrix(), rectified.size(), CV_32FC1, map_u, map_v);
  }
  cv::Mat map;
  cv::merge(std::vector<cv::Mat>{map_u, map_v}, map);
  return map;
}

/// cv::stereoRectify with the model of the lenses: both cameras share focal length and principal point
/// (CALIB_ZERO_DISPARITY), no magnification beyond valid pixels (alpha 0).
struct Rectification {
  cv::Mat R_left, R_right, P_left, P_right;
};
Rectification rectify_pair(const Rig& rig) {
  const Camera& left = rig.cam0.camera;
  const Camera& right = rig.cam1->camera;
  cv::Mat R;
  cv::Mat t;
  cv::eigen2cv(Eigen::Matrix3d(rig.T_cam1_cam0.linear()), R);
  cv::eigen2cv(Eigen::Vector3d(rig.T_cam1_cam0.translation()), t);
  Rectification result;
  cv::Mat Q;
  const cv::Size size = left.intrinsics.size();
  if (left.distortion_model == DistortionModel::kEquidistant) {
    cv::fisheye::stereoRectify(left.intrinsics.matrix(), left.distortion_coeffs, right.intrinsics.matrix(),
                               right.distortion_coeffs, size, R, t, result.R_left, result.R_right,
                               result.P_left, result.P_right, Q, cv::CALIB_ZERO_DISPARITY, size);
  } else {
    cv::stereoRectify(left.intrinsics.matrix(), left.distortion_coeffs, right.intrinsics.matrix(),
                      right.distortion_coeffs, size, R, t, result.R_left, result.R_right, result.P_left,
                      result.P_right, Q, cv::CALIB_ZERO_DISPARITY, 0, size);
  }
  return result;
}

void check_pair(const Rig& rig) {
  const Camera& left = rig.cam0.camera;
  const Camera& right = rig.cam1->camera;
  if (left.intrinsics.size() != right.intrinsics.size()) {
    throw ConfigError("rig: cam0 and cam1 differ in resolution; stereo needs equal ones");
  }
  const bool fisheye_left = left.distortion_model == DistortionModel::kEquidistant;
  const bool fisheye_right = right.distortion_model == DistortionModel::kEquidistant;
  if (fisheye_left != fisheye_right) {
    throw ConfigError(
        "rig: cam0 and cam1 have different distortion models; calibrate both with the same one");
  }
  const Eigen::Vector3d t = rig.T_cam1_cam0.translation();
  if (!(t.x() < 0 && std::abs(t.x()) > std::abs(t.y()) && std::abs(t.x()) > std::abs(t.z()))) {
    throw ConfigError(
        "rig: cam1 is not to the right of cam0 (T_cn_cnm1's x translation must be negative and the largest); "
        "swap cam0 and cam1 or check the direction of the transform");
  }
}

}  // namespace

StereoRectifier::StereoRectifier(const Rig& rig) : raw_size_(rig.cam0.camera.intrinsics.size()) {
  if (rig.cam1) check_pair(rig);
  rectified_.intrinsics = rig.cam0.camera.intrinsics;
  rectified_.baseline_m = rig.cam1 ? rig.T_cam1_cam0.translation().norm() : 0;
  Eigen::Isometry3d T_rectified_cam0 = Eigen::Isometry3d::Identity();
  if (!is_rectified(rig)) {
    if (rig.cam1) {
      const Rectification pair = rectify_pair(rig);
      rectified_.intrinsics = intrinsics_of(pair.P_left, raw_size_);
      map_left_ = rectification_map(rig.cam0.camera, pair.R_left, rectified_.intrinsics);
      map_right_ = rectification_map(rig.cam1->camera, pair.R_right, rectified_.intrinsics);
      Eigen::Matrix3d R;
      cv::cv2eigen(pair.R_left, R);
      T_rectified_cam0.linear() = R;
    } else {
      map_left_ = rectification_map(rig.cam0.camera, cv::Mat::eye(3, 3, CV_64F), rectified_.intrinsics);
    }
  }
  if (rig.lidar0) rectified_.T_camera_lidar = T_rectified_cam0 * rig.lidar0->T_camera_lidar;
  if (rig.cam0.T_camera_imu) rectified_.T_camera_imu = T_rectified_cam0 * *rig.cam0.T_camera_imu;
}

cv::Mat StereoRectifier::rectify(const cv::Mat& image, const cv::Mat& map) const {
  if (image.size() != raw_size_) {
    throw std::invalid_argument("image is " + std::to_string(image.cols) + "x" + std::to_string(image.rows) +
                                ", the rig says " + std::to_string(raw_size_.width) + "x" +
                                std::to_string(raw_size_.height));
  }
  if (map.empty()) return image;
  cv::Mat rectified;
  cv::remap(image, rectified, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return rectified;
}

cv::Mat StereoRectifier::rectify_left(const cv::Mat& image) const { return rectify(image, map_left_); }
cv::Mat StereoRectifier::rectify_right(const cv::Mat& image) const { return rectify(image, map_right_); }

RectifiedRig crop(const RectifiedRig& rig, const cv::Rect& rect) {
  RectifiedRig cropped = rig;
  cropped.intrinsics = crop(rig.intrinsics, rect);
  return cropped;
}

}  // namespace alight
