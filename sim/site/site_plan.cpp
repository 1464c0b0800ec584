#include "sim/site/site_plan.hpp"

#include <algorithm>
#include <cmath>

namespace alight::sim {
namespace {
constexpr double kRaster_m = 0.5;
constexpr double kHalfDiagonal_m = 0.36;  // a cell is taken as soon as a shape touches it
}  // namespace

SitePlan::SitePlan(double size_m)
    : half_m_(0.5 * size_m),
      cells_(static_cast<int>(std::ceil(size_m / kRaster_m))),
      taken_(static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_), 0) {}

int SitePlan::cell(double coordinate_m) const {
  return static_cast<int>(
      std::floor((std::clamp(coordinate_m, -2 * half_m_, 2 * half_m_) + half_m_) / kRaster_m));
}

Eigen::Vector2d SitePlan::centre_of(int row, int column) const {
  return {(column + 0.5) * kRaster_m - half_m_, (row + 0.5) * kRaster_m - half_m_};
}

template <class Inside>
void SitePlan::occupy(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Inside& inside) {
  for (int row = std::max(cell(low.y()), 0); row <= std::min(cell(high.y()), cells_ - 1); ++row) {
    for (int column = std::max(cell(low.x()), 0); column <= std::min(cell(high.x()), cells_ - 1); ++column) {
      if (inside(centre_of(row, column))) taken_[static_cast<std::size_t>(row * cells_ + column)] = 1;
    }
  }
}

template <class Inside>
bool SitePlan::any_taken(const Eigen::Vector2d& low, const Eigen::Vector2d& high,
                         const Inside& inside) const {
  if (cell(low.x()) < 0 || cell(low.y()) < 0 || cell(high.x()) >= cells_ || cell(high.y()) >= cells_)
    return true;
  for (int row = cell(low.y()); row <= cell(high.y()); ++row) {
    for (int column = cell(low.x()); column <= cell(high.x()); ++column) {
      if (taken_[static_cast<std::size_t>(row * cells_ + column)] != 0 && inside(centre_of(row, column)))
        return true;
    }
  }
  return false;
}

void SitePlan::occupy_disc(const Eigen::Vector2d& centre, double radius_m) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(radius_m + kRaster_m);
  occupy(centre - reach, centre + reach,
         [&](const Eigen::Vector2d& p) { return (p - centre).norm() <= radius_m + kHalfDiagonal_m; });
}

void SitePlan::occupy_rect(const GroundRect& rect, double margin_m) {
  const Eigen::Vector2d reach =
      Eigen::Vector2d::Constant(std::hypot(rect.half_u_m, rect.half_v_m) + margin_m + kRaster_m);
  occupy(rect.centre - reach, rect.centre + reach,
         [&](const Eigen::Vector2d& p) { return rect.distance_m(p) <= margin_m + kHalfDiagonal_m; });
}

void SitePlan::occupy_segment(const GroundSegment& segment, double half_width_m) {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(half_width_m + kRaster_m);
  occupy(segment.a.cwiseMin(segment.b) - reach, segment.a.cwiseMax(segment.b) + reach,
         [&](const Eigen::Vector2d& p) {
           return (p - segment.nearest(p)).norm() <= half_width_m + kHalfDiagonal_m;
         });
}

bool SitePlan::is_free(const Eigen::Vector2d& centre, double radius_m) const {
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(radius_m);
  return !any_taken(centre - reach, centre + reach, [&](const Eigen::Vector2d& p) {
    return (p - centre).norm() <= radius_m + kHalfDiagonal_m;
  });
}

bool SitePlan::is_free(const GroundRect& rect, double margin_m) const {
  const Eigen::Vector2d reach =
      Eigen::Vector2d::Constant(std::hypot(rect.half_u_m, rect.half_v_m) + margin_m);
  return !any_taken(rect.centre - reach, rect.centre + reach, [&](const Eigen::Vector2d& p) {
    return rect.distance_m(p) <= margin_m + kHalfDiagonal_m;
  });
}

std::optional<Eigen::Vector2d> SitePlan::find_free(Random& random, double radius_m, double half_width_m,
                                                   int attempts) const {
  for (int i = 0; i < attempts; ++i) {
    const double x_m = random.uniform(-half_width_m, half_width_m);
    const double y_m = random.uniform(-half_width_m, half_width_m);
    if (is_free(Eigen::Vector2d(x_m, y_m), radius_m)) return Eigen::Vector2d(x_m, y_m);
  }
  return std::nullopt;
}

}  // namespace alight::sim
