#include "infer/health/ground_memory.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <utility>
#include <vector>

#include "foundation/order_statistics.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr double kFlat_m = 0.3;    // a cell whose heights differ by more has an edge or leaves in it
constexpr double kFarOff_m = 1.0;  // farther off is not worse
constexpr int kEchoesOfACell = 8;

/// Mean distance of height differences to one of them.
double mean_off(const std::vector<double>& off_m, double from_m) {
  double sum_m = 0;
  for (const double off : off_m) sum_m += std::min(kFarOff_m, std::abs(off - from_m));
  return sum_m / static_cast<double>(off_m.size());
}

}  // namespace

std::int64_t GroundMemory::cell_of(const Eigen::Vector3d& p_world) const {
  const auto x = static_cast<std::int64_t>(std::floor(p_world.x() / config_.cell_m));
  const auto y = static_cast<std::int64_t>(std::floor(p_world.y() / config_.cell_m));
  return x * (std::int64_t{1} << 32) + y;
}

GroundFit GroundMemory::fit(const std::vector<Eigen::Vector3d>& points) const {
  std::unordered_set<std::int64_t> seen;
  std::vector<double> off_m;
  for (const Eigen::Vector3d& p_world : points) {
    const auto found = cells_.find(cell_of(p_world));
    if (found == cells_.end()) continue;
    const Cell& cell = found->second;
    if (cell.count < kEchoesOfACell || cell.max_m - cell.min_m > kFlat_m) continue;
    seen.insert(found->first);
    off_m.push_back(p_world.z() - cell.sum_m / cell.count);
  }
  GroundFit fit;
  fit.cells = static_cast<int>(seen.size());
  if (off_m.empty()) return fit;
  fit.misfit_m = mean_off(off_m, 0);
  fit.offset_m = median(off_m);
  fit.shape_misfit_m = mean_off(off_m, fit.offset_m);
  return fit;
}

GroundMemory::Cells GroundMemory::cells_of(const std::vector<Eigen::Vector3d>& points) const {
  Cells cells;
  for (const Eigen::Vector3d& p_world : points)
    cells[cell_of(p_world)].add({1, p_world.z(), p_world.z(), p_world.z()});
  return cells;
}

void GroundMemory::add(std::int64_t t_ns, const std::vector<Eigen::Vector3d>& points) {
  packets_.push_back({t_ns, cells_of(points)});
  while (to_seconds(t_ns - packets_.front().t_ns) > config_.memory_s) packets_.pop_front();
  cells_.clear();
  for (const Packet& packet : packets_) {
    for (const auto& [place, cell] : packet.cells) cells_[place].add(cell);
  }
}

void GroundMemory::Cell::add(const Cell& other) {
  min_m = count == 0 ? other.min_m : std::min(min_m, other.min_m);
  max_m = count == 0 ? other.max_m : std::max(max_m, other.max_m);
  sum_m += other.sum_m;
  count += other.count;
}

void GroundMemory::clear() {
  packets_.clear();
  cells_.clear();
}

}  // namespace alight
