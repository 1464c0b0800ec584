#pragma once

#include "sim/vehicle/flight_path.hpp"
#include "sim/vehicle/motion.hpp"

namespace alight::sim {

/// A multirotor on a path: thrust is its only force besides gravity and drag, so roll and pitch follow from
/// the acceleration and the air speed (differential flatness), and yaw is free.
class Vehicle : public Motion {
 public:
  /// @param drag_per_s deceleration by air drag per unit of velocity (about 0.15 for a DJI M600)
  explicit Vehicle(FlightPath path, double drag_per_s = 0.15);

  const FlightPath& path() const { return path_; }
  double duration_s() const override { return path_.duration_s(); }

  Eigen::Isometry3d T_world_imu(double t_s) const override;
  VehicleState state(double t_s) const override;

 private:
  FlightPath path_;
  double drag_per_s_;
};

}  // namespace alight::sim
