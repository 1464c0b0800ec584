#include "sim/sensors/lidar_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/frames.hpp"
#include "sim/sensors/livox_scan.hpp"

namespace alight::sim {
namespace {

constexpr double kWhiteLevel = 150.0;      // Livox's scale: a diffuse surface that throws back everything
constexpr std::size_t kFootprintRays = 5;  // side by side along the beam's long side
constexpr double kPulseLength_m = 0.75;    // surfaces nearer to each other than this give one echo

/// A ray of a beam with a rectangular footprint: in the middle of its stripe, give or take, so that no pattern of
/// rays shows.
Eigen::Vector3d footprint_ray(const Eigen::Vector3d& direction, const LidarConfig& config,
                              const CounterRandom& random, std::uint64_t counter, std::size_t stripe) {
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(direction).normalized();
  const Eigen::Vector3d up = direction.cross(across);
  const double share_up = (static_cast<double>(stripe) + random.uniform(counter)) / kFootprintRays - 0.5;
  const double share_across = random.uniform(counter + 1) - 0.5;
  return direction + to_radians(config.divergence_up_deg) * share_up * up +
         to_radians(config.divergence_across_deg) * share_across * across;
}

double echo_strength(const Hit& hit) {
  return hit.hit ? static_cast<double>(hit.reflectivity) / (hit.range_m * hit.range_m) : 0.0;
}

/// The strongest echo of a footprint: rays that end within a pulse's length of each other add up. Its range is their
/// mean weighted by strength, its reflectivity what they throw back of the whole beam.
Hit merge_footprint(const Hit* rays) {
  Hit best;
  double best_strength = 0;
  for (std::size_t k = 0; k < kFootprintRays; ++k) {
    double strength = 0;
    double reflectivity = 0;
    double range_m = 0;
    for (std::size_t j = 0; j < kFootprintRays; ++j) {
      if (!rays[j].hit || !rays[k].hit || std::abs(rays[j].range_m - rays[k].range_m) > kPulseLength_m)
        continue;
      strength += echo_strength(rays[j]);
      range_m += echo_strength(rays[j]) * rays[j].range_m;
      reflectivity += static_cast<double>(rays[j].reflectivity);
    }
    if (strength <= best_strength) continue;
    best_strength = strength;
    best = rays[k];
    best.range_m = range_m / strength;
    best.reflectivity = static_cast<float>(reflectivity / kFootprintRays);
  }
  return best;
}

/// The terms of a smooth error over the field of view, such as wedges and bearings leave behind, at most 1 inside it and
/// of mean zero over it.
std::array<double, 5> angle_terms(const Eigen::Vector3d& direction) {
  const double y = direction.y() / std::sin(kLivoxHalfFov_rad);
  const double z = direction.z() / std::sin(kLivoxHalfFov_rad);
  return {y, z, y * y - 0.25, y * z, z * z - 0.25};
}

/// Their coefficients, scaled so that the error is at most what the configuration says. What would be a turn of the
/// whole sensor is left out: that is its mounting.
std::array<Eigen::Vector2d, 5> angle_error(const LidarConfig& config) {
  const CounterRandom random(static_cast<std::uint64_t>(config.sensor_seed), RandomStream::kLidarAngles);
  std::array<Eigen::Vector2d, 5> error;
  for (std::size_t k = 0; k < error.size(); ++k)
    error[k] = {random.uniform(2 * k, -1, 1), random.uniform(2 * k + 1, -1, 1)};
  const double roll = 0.5 * (error[0].y() - error[1].x());
  error[0].y() -= roll;
  error[1].x() += roll;
  double sum = 0;
  for (const Eigen::Vector2d& term : error) sum += term.norm();
  for (Eigen::Vector2d& term : error) term *= to_radians(config.angle_error_deg) / sum;
  return error;
}

}  // namespace

LidarSensor::LidarSensor(const Renderer& renderer, const Motion& vehicle,
                         const Eigen::Isometry3d& T_imu_lidar, const LidarConfig& config, std::uint64_t seed)
    : renderer_(renderer),
      vehicle_(vehicle),
      T_imu_lidar_(T_imu_lidar),
      config_(config),
      range_random_(seed, RandomStream::kLidarRange),
      detection_random_(seed, RandomStream::kLidarDetection),
      footprint_random_(seed, RandomStream::kLidarFootprint),
      reflectivity_random_(seed, RandomStream::kLidarReflectivity),
      angle_error_rad_(angle_error(config)),
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

Eigen::Vector3d LidarSensor::beam(const Eigen::Vector3d& reported) const {
  if (config_.angle_error_deg <= 0) return reported;
  const std::array<double, 5> terms = angle_terms(reported);
  Eigen::Vector3d beam = reported;
  for (std::size_t k = 0; k < terms.size(); ++k) beam.tail<2>() += terms[k] * angle_error_rad_[k];
  return beam.normalized();
}

std::vector<Hit> LidarSensor::echoes(std::int64_t first, const std::vector<Eigen::Isometry3d>& T_world_lidar,
                                     const std::vector<Eigen::Vector3d>& directions_lidar) const {
  const bool wide = config_.divergence_up_deg > 0 || config_.divergence_across_deg > 0;
  const std::size_t rays = wide ? kFootprintRays : 1;
  std::vector<Eigen::Vector3d> origins;
  std::vector<Eigen::Vector3d> directions;
  std::vector<double> times_s;
  const bool moving = !renderer_.world().movers().empty();
  origins.reserve(rays * directions_lidar.size());
  directions.reserve(rays * directions_lidar.size());
  for (std::size_t i = 0; i < directions_lidar.size(); ++i) {
    const std::uint64_t counter = 2 * rays * (static_cast<std::uint64_t>(first) + i);
    const Eigen::Vector3d centre = beam(directions_lidar[i]);
    for (std::size_t k = 0; k < rays; ++k) {
      const Eigen::Vector3d ray =
          wide ? footprint_ray(centre, config_, footprint_random_, counter + 2 * k, k) : centre;
      origins.push_back(T_world_lidar[i].translation());
      directions.emplace_back(T_world_lidar[i].linear() * ray);
      if (moving) times_s.push_back(to_seconds((first + static_cast<std::int64_t>(i)) * kLivoxShotPeriod_ns));
    }
  }
  std::vector<Hit> hits;
  renderer_.cast_many(origins, directions, hits, times_s);
  if (!wide) return hits;
  std::vector<Hit> merged(directions_lidar.size());
  for (std::size_t i = 0; i < merged.size(); ++i) merged[i] = merge_footprint(&hits[i * rays]);
  return merged;
}

std::uint8_t LidarSensor::level(const Hit& hit, std::uint64_t shot) const {
  double level = kWhiteLevel * static_cast<double>(hit.reflectivity);
  if (config_.reflectivity_noise > 0) level += config_.reflectivity_noise * reflectivity_random_.normal(shot);
  return static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 150L));
}

LidarScan LidarSensor::scan(std::int64_t packet) const {
  const auto count = static_cast<std::size_t>(shots_per_packet_);
  const std::int64_t first = packet * shots_per_packet_;
  std::vector<Eigen::Vector3d> directions(count);
  std::vector<Eigen::Isometry3d> T_world_lidar(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t shot = first + static_cast<std::int64_t>(i);
    T_world_lidar[i] = vehicle_.T_world_imu(to_seconds(shot * kLivoxShotPeriod_ns)) * T_imu_lidar_;
    directions[i] = livox_direction(first_shot_ + shot);
  }
  const std::vector<Hit> hits = echoes(first, T_world_lidar, directions);

  LidarScan scan;
  scan.t_begin_ns = first * kLivoxShotPeriod_ns;
  scan.shots.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto shot = static_cast<std::uint64_t>(first) + i;
    if (!detected(hits[i], T_world_lidar[i].linear() * directions[i], shot)) continue;
    const double range_m =
        hits[i].range_m + config_.range_noise_m * range_random_.normal(shot) + config_.range_offset_m;
    scan.shots[i].p_lidar = (range_m * directions[i]).cast<float>();
    scan.shots[i].reflectivity = level(hits[i], shot);
  }
  return scan;
}

}  // namespace alight::sim
