#include "sim/lidar_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/frames.hpp"
#include "sim/livox_scan.hpp"

namespace alight::sim {

LidarSensor::LidarSensor(const Renderer& renderer, const Motion& vehicle,
                         const Eigen::Isometry3d& T_imu_lidar, const LidarConfig& config, std::uint64_t seed)
    : renderer_(renderer),
      vehicle_(vehicle),
      T_imu_lidar_(T_imu_lidar),
      config_(config),
      range_random_(seed, RandomStream::kLidarRange),
      detection_random_(seed, RandomStream::kLidarDetection),
      shots_per_packet_(to_nanoseconds(config.packet_s) / kLivoxShotPeriod_ns),
      first_shot_(static_cast<std::int64_t>(CounterRandom(seed, RandomStream::kLidarStart).bits(0) %
                                            static_cast<std::uint64_t>(kLivoxPatternShots))) {}

/// Echo strength falls with range squared and with reflectivity, so that the range limit goes with the square
/// root of the latter (Livox's 90 / 130 / 260 m at 10 / 20 / 80 %).
bool LidarSensor::detected(const Hit& hit, const Eigen::Vector3d& direction_world, std::uint64_t shot) const {
  if (!hit.hit || hit.reflectivity <= 0 || hit.range_m < config_.min_range_m) return false;
  const double reflectivity = static_cast<double>(hit.reflectivity);
  const double incidence = std::abs(hit.normal.cast<double>().dot(direction_world));
  const double limit_m = config_.range_at_80_percent_m * std::sqrt(reflectivity * incidence / 0.8);
  if (hit.range_m > limit_m) return false;
  const double darkness = std::max(0.0, 1.0 - reflectivity / std::max(config_.dark_reflectivity, 1e-9));
  return detection_random_.uniform(shot) >= config_.dark_loss * darkness;
}

LidarScan LidarSensor::scan(std::int64_t packet) const {
  const auto count = static_cast<std::size_t>(shots_per_packet_);
  const std::int64_t first = packet * shots_per_packet_;
  std::vector<Eigen::Vector3d> directions_lidar(count);
  std::vector<Eigen::Vector3d> origins(count);
  std::vector<Eigen::Vector3d> directions(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t shot = first + static_cast<std::int64_t>(i);
    const Eigen::Isometry3d T_world_lidar =
        vehicle_.T_world_imu(to_seconds(shot * kLivoxShotPeriod_ns)) * T_imu_lidar_;
    directions_lidar[i] = livox_direction(first_shot_ + shot);
    origins[i] = T_world_lidar.translation();
    directions[i] = T_world_lidar.linear() * directions_lidar[i];
  }
  std::vector<Hit> hits;
  renderer_.cast_many(origins, directions, hits);

  LidarScan scan;
  scan.t_begin_ns = first * kLivoxShotPeriod_ns;
  scan.shots.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto shot = static_cast<std::uint64_t>(first) + i;
    if (!detected(hits[i], directions[i], shot)) continue;
    const double range_m = hits[i].range_m + config_.range_noise_m * range_random_.normal(shot);
    scan.shots[i].p_lidar = (range_m * directions_lidar[i]).cast<float>();
    const long level = std::lround(150.0 * static_cast<double>(hits[i].reflectivity));
    scan.shots[i].reflectivity = static_cast<std::uint8_t>(std::clamp(level, 0L, 150L));
  }
  return scan;
}

}  // namespace alight::sim
