#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Geometry>

#include "foundation/errors.hpp"
#include "geometry/camera.hpp"
#include "geometry/rig/noise_points.hpp"
#include "geometry/rig/point_timing.hpp"
#include "geometry/rig/transform_form.hpp"

namespace alight {

/// One camera of a rig (Kalibr's camchain entry).
struct RigCamera {
  Camera camera;
  std::optional<Eigen::Isometry3d> T_camera_imu;
  double timeshift_cam_imu_s = 0;  ///< t_imu = t_cam + timeshift (Kalibr)
  StampSource stamp = StampSource::kHeader;
  std::string topic;
};

/// The LiDAR of a rig.
struct RigLidar {
  Eigen::Isometry3d T_camera_lidar = Eigen::Isometry3d::Identity();  ///< lidar -> cam0
  double timeshift_s = 0;                                            ///< t_imu = t_lidar + timeshift
  StampSource stamp = StampSource::kHeader;
  PointTiming points;
  double reflectivity_scale = 1;  ///< from the driver's intensity to 0 .. 255
  std::optional<int> lidar_id;  ///< of a topic on which a Livox driver publishes several; none: it holds one
  NoisePoints noise_points = NoisePoints::kDropLikely;
  std::string topic;
};

/// Sensors and their mounting, as calibrated. A file made by Kalibr (`camchain-imucam.yaml`) is one; ours adds `lidar0`,
/// the time stamps to use, other forms of the transforms (bind_transform) and lenses out of other programs' files
/// (read_calibration_file). `docs/formats.md` lists the keys.
struct Rig {
  RigCamera cam0;                 ///< left
  std::optional<RigCamera> cam1;  ///< right; absent: mono
  Eigen::Isometry3d T_cam1_cam0 = Eigen::Isometry3d::Identity();
  std::optional<RigLidar> lidar0;
};

/// Reads and checks a rig file. @throws ConfigError with file and line of every mistake
Rig load_rig(const std::filesystem::path& path);
/// As load_rig for text; `name` stands for the file in messages.
Rig parse_rig(const std::string& text, const std::string& name);
/// The rig as a file that load_rig reads back.
std::string format_rig(const Rig& rig);

}  // namespace alight
