#include "infer/health/ground_memory.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <utility>
#include <vector>

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
  const auto middle = off_m.begin() + static_cast<std::ptrdiff_t>(off_m.size() / 2);
  std::nth_element(off_m.begin(), middle, off_m.end());
  fit.shape_misfit_m = mean_off(off_m, *middle);
  return fit;
}

void GroundMemory::add(std::int64_t t_ns, const std::vector<Eigen::Vector3d>& points) {
  packets_.push_back({t_ns, points});
  while (to_seconds(t_ns - packets_.front().t_ns) > config_.memory_s) packets_.pop_front();
  rebuild();
}

void GroundMemory::rebuild() {
  cells_.clear();
  for (const Packet& packet : packets_) {
    for (const Eigen::Vector3d& p_world : packet.points) {
      Cell& cell = cells_[cell_of(p_world)];
      cell.min_m = cell.count == 0 ? p_world.z() : std::min(cell.min_m, p_world.z());
      cell.max_m = cell.count == 0 ? p_world.z() : std::max(cell.max_m, p_world.z());
      cell.sum_m += p_world.z();
      ++cell.count;
    }
  }
}

void GroundMemory::clear() {
  packets_.clear();
  cells_.clear();
}

}  // namespace alight
