#pragma once

#include <cstdint>

#include <opencv2/core.hpp>

#include "geometry/rig/stereo_rectification.hpp"
#include "sim/counter_random.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/sensor_config.hpp"
#include "sim/vehicle/motion.hpp"

namespace alight::sim {

/// One exposure of both cameras.
struct StereoExposure {
  cv::Mat left;  ///< CV_8UC3 BGR, with noise
  cv::Mat right;
  cv::Mat depth_m;  ///< CV_32FC1, the left camera's true plane depth, 0 = sky; empty if not asked for
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// A rectified global-shutter stereo camera on a moving vehicle.
class StereoCamera {
 public:
  /// Renderer and vehicle must outlive the camera.
  StereoCamera(const Renderer& renderer, const Motion& vehicle, const RectifiedRig& rig,
               const CameraConfig& config, std::uint64_t seed);

  /// True time of a frame's exposure, from the start of the flight.
  std::int64_t time_ns(std::int64_t frame) const;
  /// Frame number `frame`, from 0. May be called from several threads.
  StereoExposure expose_frame(std::int64_t frame, bool with_depth) const;

 private:
  const Renderer& renderer_;
  const Motion& vehicle_;
  RectifiedRig rig_;
  CameraConfig config_;
  CounterRandom left_random_;
  CounterRandom right_random_;
};

}  // namespace alight::sim
