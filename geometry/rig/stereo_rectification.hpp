#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/rig/rig.hpp"

namespace alight {

/// What everything behind the rectification sees: one undistorted camera, its twin `baseline_m` to the right
/// (p_right = p_camera - (baseline_m, 0, 0)), and where LiDAR and IMU are. `camera` is the rectified left
/// camera.
struct RectifiedRig {
  PinholeIntrinsics intrinsics;  ///< both cameras
  double baseline_m = 0;         ///< 0: mono
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d T_camera_imu = Eigen::Isometry3d::Identity();

  Eigen::Isometry3d T_right_camera() const {
    return Eigen::Isometry3d(Eigen::Translation3d(-baseline_m, 0, 0));
  }
};

/// Undistorts and rectifies both cameras (cv::stereoRectify), or the one camera of a mono rig. Images of a rig that
/// is rectified already pass through untouched.
class StereoRectifier {
 public:
  /// @throws ConfigError if the cameras' resolutions differ or the baseline is not sideways (stereo side by side
  /// only)
  explicit StereoRectifier(const Rig& rig);

  const RectifiedRig& rig() const { return rectified_; }
  bool is_identity() const { return map_left_.empty(); }

  /// @param image raw image, any depth and channels. @throws std::invalid_argument on another resolution
  cv::Mat rectify_left(const cv::Mat& image) const;
  cv::Mat rectify_right(const cv::Mat& image) const;

 private:
  cv::Mat rectify(const cv::Mat& image, const cv::Mat& map) const;

  RectifiedRig rectified_;
  cv::Size raw_size_;
  cv::Mat map_left_;  // CV_32FC2, empty: identity
  cv::Mat map_right_;
};

/// The rig of the centre-cropped images.
RectifiedRig crop(const RectifiedRig& rig, const cv::Rect& rect);

}  // namespace alight
