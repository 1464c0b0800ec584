#include "sensors/poses/packet_aligner.hpp"

#include <algorithm>
#include <utility>

#include "geometry/frames.hpp"

namespace alight {

void PacketAligner::saw(std::int64_t t_ns) { now_ns_ = std::max(now_ns_.value_or(t_ns), t_ns); }

void PacketAligner::add(const AttitudeSample& sample) {
  saw(sample.t_ns);
  if (!poses_.add(sample)) drop("attitudes not finite or not later than the one before");
}

void PacketAligner::add(const PositionSample& sample) {
  saw(sample.t_ns);
  if (!poses_.add(sample)) drop("positions not finite or not later than the one before");
}

void PacketAligner::add(const HeightSample& sample) {
  saw(sample.t_ns);
  heights_.add(sample);
}

void PacketAligner::add(LidarPacket packet) {
  saw(end_of(packet));
  if (packet.returns.empty()) return drop("LiDAR packets without returns");
  packets_.push_back(std::move(packet));
}

std::optional<WorldPacket> PacketAligner::next() {
  if (packets_.empty()) return std::nullopt;
  const std::int64_t end_ns = end_of(packets_.front());
  if (!settled(end_ns) && !late(end_ns)) return std::nullopt;
  WorldPacket placed = to_world(packets_.front(), poses_.trajectory(), T_imu_lidar_, previous_end_ns_);
  packets_.pop_front();
  previous_end_ns_ = placed.end_ns;
  placed_until_ns_ = std::max(placed_until_ns_.value_or(placed.end_ns), placed.end_ns);
  if (placed.without_pose > 0) drop("LiDAR points without a pose", placed.without_pose);
  return placed;
}

bool PacketAligner::late(std::int64_t t_ns) const {
  return now_ns_ && to_seconds(*now_ns_ - t_ns) > wait_.max_wait_s;
}

void PacketAligner::forget_before(std::int64_t t_ns) {
  poses_.forget_before(t_ns);
  heights_.forget_before(t_ns);
}

}  // namespace alight
