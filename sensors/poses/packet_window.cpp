#include "sensors/poses/packet_window.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "geometry/frames.hpp"

namespace alight {

PacketWindow::PacketWindow(std::size_t max_points) : max_points_(max_points) {}

void PacketWindow::pop_oldest() {
  points_ -= packets_.front()->points.size();
  packets_.pop_front();
}

void PacketWindow::add(WorldPacketPtr packet) {
  points_ += packet->points.size();
  const auto place =
      std::upper_bound(packets_.begin(), packets_.end(), packet->end_ns,
                       [](std::int64_t t_ns, const WorldPacketPtr& p) { return t_ns < p->end_ns; });
  packets_.insert(place, std::move(packet));
  while (points_ > max_points_ && packets_.size() > 1) pop_oldest();
}

void PacketWindow::forget_before(std::int64_t t_ns) {
  while (!packets_.empty() && packets_.front()->end_ns < t_ns) pop_oldest();
}

std::vector<WorldPacketPtr> PacketWindow::before(std::int64_t t_ns, double duration_s,
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

std::vector<WorldPacketPtr> PacketWindow::after(std::int64_t t_ns) const {
  std::vector<WorldPacketPtr> found;
  for (const WorldPacketPtr& packet : packets_) {
    if (packet->end_ns > t_ns) found.push_back(packet);
  }
  return found;
}

int PacketWindow::project(std::int64_t begin_ns, std::int64_t end_ns, const Eigen::Isometry3d& T_camera_world,
                          const PinholeIntrinsics& intrinsics, std::int64_t t_image_ns,
                          const DepthRange& range, SparseDepth& out) const {
  int inside = 0;
  for (const WorldPacketPtr& packet : packets_) {
    if (packet->end_ns < begin_ns || packet->begin_ns > end_ns) continue;
    if (packet->begin_ns >= begin_ns && packet->end_ns <= end_ns) {
      inside += project_points(packet->points, T_camera_world, intrinsics, t_image_ns, range, out);
      continue;
    }
    std::vector<WorldPoint> part;
    std::copy_if(packet->points.begin(), packet->points.end(), std::back_inserter(part),
                 [&](const WorldPoint& point) { return point.t_ns >= begin_ns && point.t_ns <= end_ns; });
    inside += project_points(part, T_camera_world, intrinsics, t_image_ns, range, out);
  }
  return inside;
}

}  // namespace alight
