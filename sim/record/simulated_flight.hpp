#pragma once

#include "geometry/rig/rig.hpp"
#include "geometry/rig/stereo_rectification.hpp"
#include "sim/record/sim_config.hpp"
#include "sim/sensors/lidar_sensor.hpp"
#include "sim/sensors/pose_sensors.hpp"
#include "sim/sensors/stereo_camera.hpp"
#include "sim/truth/surface_truth.hpp"
#include "sim/vehicle/vehicle.hpp"
#include "sim/world/world.hpp"

namespace alight::sim {

/// The rig that the simulator flies: rectified pinhole cameras and a LiDAR.
/// @throws ConfigError naming `file` if the rig is mono, has no LiDAR or is not rectified
RectifiedRig flyable_rig(const Rig& rig, const std::string& file);

/// The rig file that fits a simulated log: the sensors' clock offsets appear as time shifts to the IMU's
/// clock.
Rig true_rig(const Rig& rig, const SensorsConfig& sensors);

/// A place, a vehicle on its path and the sensors on it. Everything is a pure function of the configuration.
///
/// Frames: `sim_world` is World's (origin in the middle of the place); `world` is the frame that a reader of
/// the log builds: East-North-Up with its origin at the vehicle's position at the first fix. They differ by a
/// shift.
class SimulatedFlight {
 public:
  /// @throws ConfigError if the path cannot be flown
  SimulatedFlight(const FlightConfig& flight, const SimConfig& config, const RectifiedRig& rig);
  SimulatedFlight(const SimulatedFlight&) = delete;
  SimulatedFlight& operator=(const SimulatedFlight&) = delete;

  const Renderer& renderer() const { return renderer_; }
  const SurfaceTruth& surface_truth() const { return truth_; }
  const Vehicle& vehicle() const { return vehicle_; }
  const StereoCamera& camera() const { return camera_; }
  const LidarSensor& lidar() const { return lidar_; }
  const PoseSensors& pose() const { return pose_; }

  /// Height of the ground at the take-off place in sim_world.
  double ground_m() const { return ground_m_; }
  /// T_world_imu in the log reader's world.
  Eigen::Isometry3d T_world_imu(double t_s) const;

 private:
  World world_;
  Renderer renderer_;
  SurfaceTruth truth_;
  double ground_m_;
  Vehicle vehicle_;
  SensorsConfig sensors_;
  StereoCamera camera_;
  LidarSensor lidar_;
  PoseSensors pose_;
};

}  // namespace alight::sim
