#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "foundation/binder_fwd.hpp"
#include "geometry/camera.hpp"
#include "geometry/rig/point_timing.hpp"

namespace alight {

/// One camera of a rig file, in Kalibr's keys, with ours beside them.
struct KalibrCamera {
  std::optional<std::string> calibration_file;
  std::string calibration_entry;
  std::string camera_model = "pinhole";
  std::vector<double> intrinsics;
  std::string distortion_model = "none";
  std::vector<double> distortion_coeffs;
  std::vector<int> resolution;
  std::optional<Eigen::Isometry3d> T_cn_cnm1;
  std::optional<Eigen::Isometry3d> T_cam_imu;
  double timeshift_cam_imu = 0;
  StampSource stamp = StampSource::kHeader;
  std::string rostopic;
};
void bind(Binder& b, KalibrCamera& c);

/// The lens of an entry that passed its checks and names no calibration_file.
Camera lens_of(const KalibrCamera& camera);
/// Sets an entry's keys to say this lens.
void set_lens(const Camera& camera, KalibrCamera& entry);

}  // namespace alight
