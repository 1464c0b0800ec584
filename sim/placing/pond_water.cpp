#include "sim/placing/pond_water.hpp"

#include <cmath>

#include "sim/random.hpp"

namespace alight::sim {

void add_water(const std::vector<Pond>& ponds, SurfaceTable& surfaces, TriangleMesh& mesh) {
  constexpr int kCorners = 40;
  for (const Pond& pond : ponds) {
    const std::uint16_t water = surfaces.add(Material::kWater);
    const auto at_level = [&](const Eigen::Vector2d& p) {
      return Eigen::Vector3d(p.x(), p.y(), pond.level_m).cast<float>().eval();
    };
    const auto corner = [&](int i) {
      const double angle = kTwoPi * i / kCorners;
      return at_level(pond.centre + pond.radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    };
    const Eigen::Vector3f middle = at_level(pond.centre);
    for (int i = 0; i < kCorners; ++i) mesh.add_triangle(middle, corner(i), corner(i + 1), water);
  }
}

}  // namespace alight::sim
