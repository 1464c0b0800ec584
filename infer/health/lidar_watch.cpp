#include "infer/health/lidar_watch.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "foundation/order_statistics.hpp"
#include "geometry/frames.hpp"
#include "sensors/poses/alignment.hpp"

namespace alight {
namespace {

constexpr std::size_t kUsualPackets = 20;
constexpr std::size_t kComparedEchoes = 2000;
const Eigen::Vector3d kMirrors[] = {{1, -1, 1}, {1, 1, -1}, {1, -1, -1}};  // left-right, front-back, both
constexpr std::int64_t kNeighbours_ns = 50'000;  // further apart in time is further apart in angle

}  // namespace

LidarWatch::LidarWatch(const HealthConfig& config, const Eigen::Isometry3d& T_imu_lidar)
    : config_(config),
      T_imu_lidar_(T_imu_lidar),
      ground_(config.lidar),
      doubted_(config.lidar),
      partial_("lidar", "points missing"),
      noise_("lidar", "noise"),
      frozen_("lidar", "frozen"),
      mirrored_("lidar", "mirrored"),
      strange_("lidar", "contradicts the pose") {}

bool LidarWatch::add(const LidarPacket& packet, const Trajectory& trajectory) {
  const std::int64_t t_ns = packet.t_ns;
  count_points(t_ns, packet);
  if (packet.returns.empty()) return usable();
  const bool is_frozen = frozen(t_ns, packet);
  const bool is_noisy = noisy(t_ns, packet);
  const bool bad = contradicts_ground(t_ns, packet, trajectory) || is_frozen || is_noisy;
  std::vector<float> ahead_m;
  for (const LidarReturn& echo : packet.returns) ahead_m.push_back(echo.p_lidar.x());
  distance_m_ = static_cast<double>(median(ahead_m));
  last_ = packet.returns;
  return !bad && usable();
}

void LidarWatch::count_points(std::int64_t t_ns, const LidarPacket& packet) {
  const double count = static_cast<double>(packet.returns.size()) + static_cast<double>(packet.dropped);
  const double usual =
      point_counts_.empty() ? count : median(std::vector<double>(point_counts_.begin(), point_counts_.end()));
  const bool few = count < config_.lidar.min_point_share * usual;
  partial_.look(config_, t_ns, few, fmt::format("{:.0f} points in a packet, usually {:.0f}", count, usual));
  // What is too little does not become the usual.
  if (!few) point_counts_.push_back(count);
  if (point_counts_.size() > kUsualPackets) point_counts_.pop_front();
}

/// Rain, snow, dust and crosstalk send back single shots; a branch or a wire fills neighbouring ones.
bool LidarWatch::noisy(std::int64_t t_ns, const LidarPacket& packet) {
  const auto& returns = packet.returns;
  std::size_t spikes = 0;
  for (std::size_t i = 1; i + 1 < returns.size(); ++i) {
    if (returns[i].t_ns - returns[i - 1].t_ns > kNeighbours_ns ||
        returns[i + 1].t_ns - returns[i].t_ns > kNeighbours_ns)
      continue;
    const auto range_m = static_cast<double>(returns[i].p_lidar.norm());
    const auto around_m =
        static_cast<double>(std::min(returns[i - 1].p_lidar.norm(), returns[i + 1].p_lidar.norm()));
    if (around_m - range_m > std::max(config_.lidar.spike_m, config_.lidar.spike_relative * around_m))
      ++spikes;
  }
  const double share = static_cast<double>(spikes) / static_cast<double>(returns.size());
  const bool noise = share > config_.lidar.max_spike_share;
  noise_.look(config_, t_ns, noise,
              fmt::format("{:.1f} % of the echoes stand alone in the air, at most {:.1f} % expected",
                          100 * share, 100 * config_.lidar.max_spike_share));
  return noise;
}

bool LidarWatch::frozen(std::int64_t t_ns, const LidarPacket& packet) {
  const auto same = [](const LidarReturn& a, const LidarReturn& b) { return a.p_lidar == b.p_lidar; };
  const bool frozen = packet.returns.size() == last_.size() &&
                      std::equal(last_.begin(), last_.end(), packet.returns.begin(), same);
  frozen_.look(config_, t_ns, frozen, "the same echoes again and again");
  return frozen;
}

std::vector<Eigen::Vector3d> LidarWatch::in_world(const LidarPacket& packet, const Trajectory& trajectory,
                                                  const Eigen::Vector3d& signs) const {
  const std::size_t step = std::max<std::size_t>(1, packet.returns.size() / kComparedEchoes);
  std::vector<LidarReturn> some;
  for (std::size_t i = 0; i < packet.returns.size(); i += step) {
    some.push_back(packet.returns[i]);
    some.back().p_lidar = some.back().p_lidar.cwiseProduct(signs.cast<float>());
  }
  std::vector<Eigen::Vector3d> points;
  for (const WorldPoint& point : align_points(some, trajectory, T_imu_lidar_).points)
    points.push_back(point.p_world);
  return points;
}

bool LidarWatch::mirror_fits(const LidarPacket& packet, const Trajectory& trajectory, double misfit_m) {
  bool any = false;
  for (std::size_t i = 0; i < std::size(kMirrors); ++i) {
    const GroundFit fit = ground_.fit(in_world(packet, trajectory, kMirrors[i]));
    if (fit.cells < config_.lidar.min_cells || fit.misfit_m >= config_.lidar.mirror_gain * misfit_m) continue;
    mirrors_fitted_[i] = true;
    any = true;
  }
  return any;
}

/// A mirrored LiDAR is believed again only by the ground from before: over level ground its echoes would agree with
/// everything, and the next house would stand on the wrong side. For recover_s every packet that tells the one from the
/// other has to fit as it is, and no mirror image that fitted before may.
void LidarWatch::watch_mirror(const LidarPacket& packet, const Trajectory& trajectory, const GroundFit& fit) {
  const LidarHealthConfig& limits = config_.lidar;
  if (fit.cells < limits.min_cells) return;
  bool straight = fit.misfit_m <= limits.max_misfit_m;
  for (std::size_t i = 0; i < std::size(kMirrors); ++i) {
    if (!mirrors_fitted_[i]) continue;
    const GroundFit image = ground_.fit(in_world(packet, trajectory, kMirrors[i]));
    if (image.cells >= limits.min_cells && image.shape_misfit_m < limits.mirror_gain * fit.shape_misfit_m)
      straight_ns_.reset();
    straight = straight && image.cells >= limits.min_cells &&
               image.shape_misfit_m >= limits.mirror_misfit_m &&
               fit.shape_misfit_m < limits.mirror_gain * image.shape_misfit_m;
  }
  if (!straight) return;
  if (!straight_ns_) straight_ns_ = packet.t_ns;
  if (to_seconds(packet.t_ns - *straight_ns_) < config_.recover_s) return;
  mirrored_.clear();
  mirrors_fitted_ = {};
  straight_ns_.reset();
  doubted_.clear();
}

/// A packet that contradicts the ground does not become part of it. As the vehicle flies on, that ground falls behind;
/// then the doubted packets have to be at one among themselves before they are believed again.
bool LidarWatch::contradicts_ground(std::int64_t t_ns, const LidarPacket& packet,
                                    const Trajectory& trajectory) {
  const LidarHealthConfig& limits = config_.lidar;
  const std::vector<Eigen::Vector3d> points = in_world(packet, trajectory, {1, 1, 1});
  if (mirrored_.present()) {
    watch_mirror(packet, trajectory, ground_.fit(points));
    return mirrored_.present();
  }
  const bool doubted = strange_.present();
  const GroundFit fit = (doubted ? doubted_ : ground_).fit(points);
  const bool common = fit.cells >= limits.min_cells;
  const bool mirrored = !doubted && common && fit.misfit_m >= limits.mirror_misfit_m &&
                        mirror_fits(packet, trajectory, fit.misfit_m);
  const bool strange = !mirrored && (common ? fit.misfit_m > limits.max_misfit_m : doubted);
  const std::string reason = fmt::format("{:.2f} m off the ground of the second before", fit.misfit_m);
  mirrored_.look(config_, t_ns, mirrored, reason + "; mirrored it fits");
  if (!mirrored_.suspected()) mirrors_fitted_ = {};
  strange_.look(config_, t_ns, strange, reason);
  const bool recovered = doubted && !strange_.present();
  if (recovered) {
    std::swap(ground_, doubted_);
    doubted_.clear();
  }
  const bool aside = !recovered && (doubted || strange || mirrored);
  (aside ? doubted_ : ground_).add(t_ns, points);
  return strange || mirrored;
}

bool LidarWatch::usable() const {
  return !noise_.present() && !frozen_.present() && !mirrored_.present() && !strange_.present();
}

void LidarWatch::report(std::vector<HealthFinding>& findings) const {
  for (const Symptom* symptom : {&partial_, &noise_, &frozen_, &mirrored_, &strange_})
    symptom->report(findings);
}

}  // namespace alight
