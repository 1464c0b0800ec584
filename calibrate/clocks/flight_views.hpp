#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "calibrate/clocks/depth_edges.hpp"
#include "foundation/binder_fwd.hpp"
#include "foundation/errors.hpp"
#include "geometry/rig/stereo_rectification.hpp"
#include "geometry/trajectory.hpp"
#include "sensors/stream/log_config.hpp"

namespace alight {

/// What is kept of a flight to hold its sensors against each other.
struct FlightViewsConfig {
  double view_step_s = 0.25;  ///< between the images that are kept
  int max_views = 160;        ///< of a long flight, evenly spread
  int every_nth_point = 10;   ///< of the LiDAR's points; of its depth edges all are kept
  double max_pose_gap_s = 0.25;
  DepthEdgeConfig edges;
};
void bind(Binder& b, FlightViewsConfig& c);

/// A rectified exposure.
struct ExposureView {
  std::int64_t t_ns = 0;
  cv::Mat left;   ///< CV_8UC1
  cv::Mat right;  ///< empty: mono
};

/// A flight's poses, some of its images, and of its LiDAR what steps in depth and a share of the points, all in the order
/// of time and in the sensors' own frames: nothing in it depends on how LiDAR and IMU are mounted.
struct FlightViews {
  RectifiedRig rig;
  Trajectory trajectory{0.25};
  std::vector<ExposureView> views;
  std::vector<LidarReturn> edges;
  std::vector<LidarReturn> points;
};

/// Reads a whole log. @param progress messages read and all of them
/// @throws DataError, ConfigError as FlightLog; ConfigError where the rig has no LiDAR or no T_cam_imu
FlightViews read_flight_views(const std::filesystem::path& log, const Rig& rig, const LogConfig& log_config,
                              const FlightViewsConfig& config,
                              const std::function<void(std::int64_t, std::int64_t)>& progress = {});

/// As read_flight_views, with a progress bar.
FlightViews read_flight_views_with_bar(const std::filesystem::path& log, const Rig& rig,
                                       const LogConfig& log_config, const FlightViewsConfig& config);

/// A LiDAR point and an image that sees it.
struct SeenPoint {
  Eigen::Vector3d p_own = Eigen::Vector3d::Zero();  ///< in the left camera's frame at the point's own time
  Eigen::Isometry3d T_view_own =
      Eigen::Isometry3d::Identity();  ///< the camera's motion from then to the image
};

/// The returns measured within half a window of an image's time, each carried along by the vehicle's motion (paper 3.1
/// step 2). Returns without a pose are left out; all of them are where the image has none.
/// @param returns in the order of time. @param lidar_shift_ns added to the returns' times for their poses; which returns are
/// used does not depend on it
std::vector<SeenPoint> seen_from(const FlightViews& flight, const ExposureView& view,
                                 const std::vector<LidarReturn>& returns, double window_s,
                                 std::int64_t lidar_shift_ns = 0);

}  // namespace alight
