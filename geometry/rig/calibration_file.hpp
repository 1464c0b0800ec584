#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "foundation/errors.hpp"
#include "geometry/camera.hpp"

namespace alight {

/// What another program's calibration file says of one camera.
struct CalibratedCamera {
  Camera camera;
  std::optional<Eigen::Isometry3d> T_camera_previous;  ///< from the camera before it: left -> right
  std::optional<Eigen::Isometry3d> T_camera_imu;
  double timeshift_cam_imu_s = 0;
};

/// Reads one camera of a calibration file:
///   Kalibr        camchain, with an entry for each camera
///   ROS           camera_info YAML
///   OpenCV        FileStorage with camera_matrix, distortion_coefficients, image_width and image_height
///   MYNT EYE      img.params, with the entries left and right and a block for each resolution
/// @param entry "cam0", "cam1", ... or "left", "right"; empty for files of one camera
/// @param resolution chooses a block where the file has several
/// @throws ConfigError naming the file, what is wrong or missing, and what there is to choose from
CalibratedCamera read_calibration_file(const std::filesystem::path& path, const std::string& entry,
                                       const std::optional<cv::Size>& resolution);

}  // namespace alight
