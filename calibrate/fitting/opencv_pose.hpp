#pragma once

#include <Eigen/Geometry>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace alight {

/// OpenCV's rotation vector and translation (three doubles each, in any arrangement) as a transform.
inline Eigen::Isometry3d isometry_of(const cv::Mat& rotation, const cv::Mat& translation) {
  cv::Mat R;
  cv::Rodrigues(rotation, R);
  Eigen::Matrix3d R_eigen;
  cv::cv2eigen(R, R_eigen);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R_eigen;
  const cv::Mat t = translation.reshape(1, 3);
  T.translation() = Eigen::Vector3d(t.at<double>(0), t.at<double>(1), t.at<double>(2));
  return T;
}

}  // namespace alight
