#include "infer/depth/accumulator.hpp"

#include <algorithm>
#include <utility>

#include "geometry/frames.hpp"
#include "sensors/poses/alignment.hpp"

namespace alight {
namespace {

/// A packet after a pause did not measure during the pause.
constexpr double kLongestPacket_s = 0.2;

}  // namespace

std::int64_t end_of(const LidarPacket& packet) {
  std::int64_t end_ns = packet.t_ns;
  if (!packet.returns.empty()) end_ns = packet.returns.front().t_ns;
  for (const LidarReturn& echo : packet.returns) end_ns = std::max(end_ns, echo.t_ns);
  return end_ns;
}

WorldPacket to_world(const LidarPacket& packet, const Trajectory& trajectory,
                     const Eigen::Isometry3d& T_imu_lidar, std::optional<std::int64_t> previous_end_ns) {
  WorldPacket world;
  world.end_ns = end_of(packet);
  world.begin_ns = world.end_ns;
  for (const LidarReturn& echo : packet.returns) world.begin_ns = std::min(world.begin_ns, echo.t_ns);
  AlignedPoints aligned = align_points(packet.returns, trajectory, T_imu_lidar);
  world.points = std::move(aligned.points);
  world.without_pose = aligned.without_pose;
  world.duration_s = to_seconds(world.end_ns - world.begin_ns);
  if (world.duration_s <= 0 && previous_end_ns)
    world.duration_s = to_seconds(world.end_ns - *previous_end_ns);
  world.duration_s = std::clamp(world.duration_s, 0.0, kLongestPacket_s);
  return world;
}

Accumulator::Accumulator(std::size_t max_points) : max_points_(max_points) {}

void Accumulator::pop_oldest() {
  points_ -= packets_.front()->points.size();
  packets_.pop_front();
}

void Accumulator::add(WorldPacketPtr packet) {
  points_ += packet->points.size();
  const auto place =
      std::upper_bound(packets_.begin(), packets_.end(), packet->end_ns,
                       [](std::int64_t t_ns, const WorldPacketPtr& p) { return t_ns < p->end_ns; });
  packets_.insert(place, std::move(packet));
  while (points_ > max_points_ && packets_.size() > 1) pop_oldest();
}

void Accumulator::forget_before(std::int64_t t_ns) {
  while (!packets_.empty() && packets_.front()->end_ns < t_ns) pop_oldest();
}

std::vector<WorldPacketPtr> Accumulator::before(std::int64_t t_ns, double duration_s,
                                                double max_age_s) const {
  std::vector<WorldPacketPtr> found;
  double total_s = 0;
  for (auto packet = packets_.rbegin(); packet != packets_.rend(); ++packet) {
    if ((*packet)->end_ns > t_ns) continue;
    if (to_seconds(t_ns - (*packet)->begin_ns) > max_age_s) break;
    found.push_back(*packet);
    if (total_s >= duration_s) break;
    total_s += (*packet)->duration_s;
  }
  return found;
}

std::vector<WorldPacketPtr> Accumulator::after(std::int64_t t_ns) const {
  std::vector<WorldPacketPtr> found;
  for (const WorldPacketPtr& packet : packets_) {
    if (packet->end_ns > t_ns) found.push_back(packet);
  }
  return found;
}

}  // namespace alight
