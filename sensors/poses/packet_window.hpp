#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

#include "geometry/projection.hpp"
#include "sensors/poses/alignment.hpp"

namespace alight {

/// The LiDAR's recent past, in bounded memory: packets older than what any image may still ask for are forgotten, and never
/// more than `max_points` are held.
class PacketWindow {
 public:
  explicit PacketWindow(std::size_t max_points = std::numeric_limits<std::size_t>::max());

  void add(WorldPacketPtr packet);
  void forget_before(std::int64_t t_ns);

  /// Packets that ended by `t_ns`, newest first, reaching back `duration_s` of LiDAR time but no farther than
  /// `max_age_s`, and one more if there is one: it is held out, to judge a prediction from all the others.
  std::vector<WorldPacketPtr> before(std::int64_t t_ns, double duration_s, double max_age_s) const;
  /// Packets that ended later, oldest first.
  std::vector<WorldPacketPtr> after(std::int64_t t_ns) const;

  /// Projects the points of [begin_ns, end_ns] into an image. @returns points that fell into the image and range
  int project(std::int64_t begin_ns, std::int64_t end_ns, const Eigen::Isometry3d& T_camera_world,
              const PinholeIntrinsics& intrinsics, std::int64_t t_image_ns, const DepthRange& range,
              SparseDepth& out) const;

  std::size_t points() const { return points_; }
  std::size_t packets() const { return packets_.size(); }

 private:
  void pop_oldest();

  std::size_t max_points_;
  std::size_t points_ = 0;
  std::deque<WorldPacketPtr> packets_;  // by end time
};

}  // namespace alight
