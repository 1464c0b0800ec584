#include "sim/placing/roadside.hpp"

#include <algorithm>

namespace alight::sim {

Eigen::Vector2d Roadside::at(double from_middle_m) const {
  const Eigen::Vector2d along = road->line.direction();
  const Eigen::Vector2d middle = 0.5 * (road->line.a + road->line.b);
  return middle + along * along_m + left_of(along) * (side * from_middle_m);
}

Eigen::Vector2d Roadside::outwards() const { return side * left_of(road->line.direction()); }

Roadside draw_roadside(const std::vector<Road>& roads, double size_m, Random& random) {
  Roadside place;
  place.road = &random.pick(roads);
  place.side = random.chance(0.5) ? 1 : -1;
  place.along_m = random.uniform(-0.5, 0.5) * size_m;
  return place;
}

bool is_crossing(const std::vector<Road>& roads, const Road& road, const Eigen::Vector2d& p) {
  return std::any_of(roads.begin(), roads.end(), [&](const Road& other) {
    return &other != &road && (p - other.line.nearest(p)).norm() < 0.5 * other.width_m + 1.0;
  });
}

}  // namespace alight::sim
