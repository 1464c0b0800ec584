#include "sim/record/simulated_flight.hpp"

namespace alight::sim {
namespace {

FlightPath checked_path(const FlightConfig& flight, const RecorderConfig& recorder, double ground_m,
                        const SurfaceTruth& truth) {
  FlightPath path =
      plan_flight(flight.plan, static_cast<std::uint64_t>(flight.seed), ground_m, &truth, flight.name);
  check_path(path, truth, recorder.clearance_m, recorder.edge_margin_m, flight.name);
  return path;
}

}  // namespace

RectifiedRig flyable_rig(const Rig& rig, const std::string& file) {
  if (!rig.cam1) throw ConfigError(file + ": has no cam1; the simulator flies a stereo camera");
  if (!rig.lidar0) throw ConfigError(file + ": has no lidar0; the simulator flies a LiDAR");
  if (!rig.cam0.T_camera_imu)
    throw ConfigError(file + ": cam0 has no T_cam_imu; the simulator needs the mounting");
  const StereoRectifier rectifier(rig);
  if (!rectifier.is_identity()) {
    throw ConfigError(
        file + ": its cameras are not rectified; the simulator makes ideal pinhole images, so that both " +
        "cameras need the same intrinsics, no distortion and parallel axes");
  }
  return rectifier.rig();
}

Rig true_rig(const Rig& rig, const SensorsConfig& sensors) {
  Rig result = rig;
  // stamp = true time + offset of its clock, and t_imu = t_sensor + timeshift
  const double camera_shift_s = sensors.pose_clock_offset_s - sensors.camera.clock_offset_s;
  result.cam0.timeshift_cam_imu_s = camera_shift_s;
  if (result.cam1) result.cam1->timeshift_cam_imu_s = camera_shift_s;
  if (result.lidar0) result.lidar0->timeshift_s = sensors.pose_clock_offset_s - sensors.lidar.clock_offset_s;
  return result;
}

SimulatedFlight::SimulatedFlight(const FlightConfig& flight, const SimConfig& config, const RectifiedRig& rig)
    : world_(flight.world),
      renderer_(world_, config.renderer),
      truth_(renderer_, config.surface_truth),
      ground_m_(world_.ground_height_m(flight.plan.start_x_m, flight.plan.start_y_m)),
      vehicle_(checked_path(flight, config.recorder, ground_m_, truth_), flight.plan.drag_per_s),
      sensors_(effective(config.sensors)),
      camera_(renderer_, vehicle_, rig, sensors_.camera, static_cast<std::uint64_t>(flight.seed)),
      lidar_(renderer_, vehicle_, rig.T_camera_imu.inverse() * rig.T_camera_lidar, sensors_.lidar,
             static_cast<std::uint64_t>(flight.seed)),
      pose_(vehicle_, sensors_, static_cast<std::uint64_t>(flight.seed), ground_m_) {}

Eigen::Isometry3d SimulatedFlight::T_world_imu(double t_s) const {
  Eigen::Isometry3d T = vehicle_.T_world_imu(t_s);
  T.translation() -= vehicle_.path().at(0).p_world;
  return T;
}

}  // namespace alight::sim
