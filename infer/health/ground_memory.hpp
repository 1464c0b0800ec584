#pragma once

#include <cstdint>
#include <deque>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "infer/health/health_config.hpp"

namespace alight {

/// How echoes fit to the ground that was measured just before.
struct GroundFit {
  int cells = 0;        ///< flat cells that both saw; below LidarHealthConfig::min_cells nothing is said
  double misfit_m = 0;  ///< mean height difference there, each no more than a metre
  double offset_m = 0;  ///< middle height difference there, positive: the echoes lie higher
  double shape_misfit_m =
      0;  ///< what is left of it where the middle difference is taken away: a drift of the height
};

/// The heights of the last second's LiDAR echoes in the world, in square cells. As the vehicle moves and tilts, echoes
/// of a healthy LiDAR keep meeting the same ground; mirrored, frozen or wrongly timed ones do not.
class GroundMemory {
 public:
  explicit GroundMemory(const LidarHealthConfig& config) : config_(config) {}

  /// @param points world
  GroundFit fit(const std::vector<Eigen::Vector3d>& points) const;
  /// Adds a packet's echoes and forgets those of more than memory_s before.
  void add(std::int64_t t_ns, const std::vector<Eigen::Vector3d>& points);
  void clear();

 private:
  struct Cell {
    int count = 0;
    double min_m = 0;
    double max_m = 0;
    double sum_m = 0;

    void add(const Cell& other);
  };
  using Cells = std::unordered_map<std::int64_t, Cell>;
  struct Packet {
    std::int64_t t_ns;
    Cells cells;
  };

  std::int64_t cell_of(const Eigen::Vector3d& p_world) const;
  Cells cells_of(const std::vector<Eigen::Vector3d>& points) const;

  LidarHealthConfig config_;
  std::deque<Packet> packets_;
  Cells cells_;
};

}  // namespace alight
