#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "sim/counter_random.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/sensor_config.hpp"
#include "sim/vehicle/motion.hpp"

namespace alight::sim {

/// One shot. A shot without return is (0, 0, 0), as the Livox driver publishes it.
struct LidarShot {
  Eigen::Vector3f p_lidar = Eigen::Vector3f::Zero();
  std::uint8_t reflectivity = 0;  ///< 150 = a white diffuse surface (Livox's scale)
};

/// The shots of one message, kLivoxShotPeriod_ns apart.
struct LidarScan {
  std::int64_t t_begin_ns = 0;  ///< true time of the first shot, from the start of the flight
  std::vector<LidarShot> shots;
};

/// A Livox Mid-40 on a moving vehicle: every shot leaves from where the vehicle is at the shot's own time, and
/// meets what moves where that is at the same time.
class LidarSensor {
 public:
  /// Renderer and vehicle must outlive the sensor.
  LidarSensor(const Renderer& renderer, const Motion& vehicle, const Eigen::Isometry3d& T_imu_lidar,
              const LidarConfig& config, std::uint64_t seed);

  std::int64_t shots_per_packet() const { return shots_per_packet_; }
  /// Message number `packet`, from 0. May be called from several threads.
  LidarScan scan(std::int64_t packet) const;

 private:
  /// Where a beam really goes, which is reported to go along `reported` (unit).
  Eigen::Vector3d beam(const Eigen::Vector3d& reported) const;
  /// What the beam of each shot meets: its centre ray, or the rays of its footprint merged to one echo.
  std::vector<Hit> echoes(std::int64_t first, const std::vector<Eigen::Isometry3d>& T_world_lidar,
                          const std::vector<Eigen::Vector3d>& directions_lidar) const;
  std::uint8_t level(const Hit& hit, std::uint64_t shot) const;
  bool detected(const Hit& hit, const Eigen::Vector3d& direction_world, std::uint64_t shot) const;

  const Renderer& renderer_;
  const Motion& vehicle_;
  Eigen::Isometry3d T_imu_lidar_;
  LidarConfig config_;
  CounterRandom range_random_;
  CounterRandom detection_random_;
  CounterRandom footprint_random_;
  CounterRandom reflectivity_random_;
  std::array<Eigen::Vector2d, 5> angle_error_rad_;  // coefficients over the field of view
  std::int64_t shots_per_packet_;
  std::int64_t first_shot_;  // where in its pattern the rosette is when the flight starts
};

}  // namespace alight::sim
