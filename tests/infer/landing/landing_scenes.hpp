#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"
#include "geometry/frames.hpp"

/// Grounds with a known answer, seen from above.
namespace alight::scenes {

inline PinholeIntrinsics camera_of(int width_px, int height_px) {
  return {440, 440, (width_px - 1) / 2.0, (height_px - 1) / 2.0, width_px, height_px};
}

/// x = image right, y = image down, z = down, from the camera: the depth of a plane z = z0 + gx x + gy y.
inline cv::Mat plane(const PinholeIntrinsics& k, double z0_m, double gx, double gy) {
  cv::Mat depth(k.size(), CV_32FC1);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const Eigen::Vector3d ray = k.ray(u, v);
      depth.at<float>(v, u) = static_cast<float>(z0_m / (1 - gx * ray.x() - gy * ray.y()));
    }
  }
  return depth;
}

/// A camera straight above level ground.
inline cv::Mat level_ground(const PinholeIntrinsics& k, double z_m) { return plane(k, z_m, 0, 0); }

/// Looks straight down, image up = north, then rolls about its x and pitches about its y axis.
inline Eigen::Matrix3d attitude(double tilt_x_rad, double tilt_y_rad, double yaw_rad = 0) {
  Eigen::Matrix3d R_world_down;  // columns: camera axes in East-North-Up
  R_world_down << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * R_world_down *
         Eigen::AngleAxisd(tilt_x_rad, Eigen::Vector3d::UnitX()).toRotationMatrix() *
         Eigen::AngleAxisd(tilt_y_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
}

/// Depth of level ground `height_m` below a camera of any attitude.
inline cv::Mat level_ground_seen(const PinholeIntrinsics& k, double height_m,
                                 const Eigen::Matrix3d& R_world_camera) {
  cv::Mat depth(k.size(), CV_32FC1, cv::Scalar(0));
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const double down = -(R_world_camera * k.ray(u, v)).z();
      if (down > 0) depth.at<float>(v, u) = static_cast<float>(height_m / down);
    }
  }
  return depth;
}

/// A camera that looks down from a place of the world.
inline Eigen::Isometry3d camera_at(double x_m, double y_m, double z_m, double roll_deg = 0,
                                   double pitch_deg = 0, double yaw_rad = 0) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = attitude(to_radians(roll_deg), to_radians(pitch_deg), yaw_rad);
  T.translation() = Eigen::Vector3d(x_m, y_m, z_m);
  return T;
}

/// Depth of the plane z = z0 + gx x + gy y of the world, seen by a camera of any pose.
inline cv::Mat plane_seen(const PinholeIntrinsics& k, const Eigen::Isometry3d& T, double z0_m, double gx,
                          double gy) {
  cv::Mat depth = cv::Mat::zeros(k.size(), CV_32FC1);
  const Eigen::Vector3d normal(-gx, -gy, 1);
  for (int v = 0; v < depth.rows; ++v) {
    for (int u = 0; u < depth.cols; ++u) {
      const double slant = normal.dot(T.linear() * k.ray(u, v));
      const double z_m = (z0_m - normal.dot(T.translation())) / slant;
      if (z_m > 0) depth.at<float>(v, u) = static_cast<float>(z_m);
    }
  }
  return depth;
}

/// Adds range noise to every known pixel.
inline cv::Mat with_noise(const cv::Mat& depth_m, double sigma_m, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0.0F, static_cast<float>(sigma_m));
  cv::Mat noisy = depth_m.clone();
  for (int v = 0; v < noisy.rows; ++v) {
    for (int u = 0; u < noisy.cols; ++u) {
      if (noisy.at<float>(v, u) > 0) noisy.at<float>(v, u) += noise(random);
    }
  }
  return noisy;
}

/// Metric disc on level ground: lets `inside` see the ground point of every pixel.
inline void change(cv::Mat& depth_m, const PinholeIntrinsics& k, double z_m,
                   const std::function<bool(double, double)>& where, float new_depth_m) {
  for (int v = 0; v < depth_m.rows; ++v) {
    for (int u = 0; u < depth_m.cols; ++u) {
      const Eigen::Vector3d p = k.ray(u, v) * z_m;
      if (where(p.x(), p.y())) depth_m.at<float>(v, u) = new_depth_m;
    }
  }
}

}  // namespace alight::scenes
