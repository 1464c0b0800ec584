#include "sim/site/ground_cover.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "foundation/parallel_rows.hpp"
#include "sim/value_noise.hpp"

namespace alight::sim {
namespace {

/// What lies where on a site.
class CoverMap {
 public:
  CoverMap(const WorldSpec& spec, const SiteLayout& layout, const CoverSurfaces& covers)
      : layout_(layout), covers_(covers), seed_(mix_bits(static_cast<std::uint32_t>(spec.seed()), 79U)) {
    const RoadNet net = spec.look().road_net;
    shoulder_m_ = net == RoadNet::kGrid ? 2.5 : (net == RoadNet::kCross ? 0.5 : 0.0);
  }

  /// @param plots those that the point may lie on
  std::uint16_t at(const Eigen::Vector2d& p, const std::vector<const Plot*>& plots) const {
    if (const auto road = road_at(p)) return *road;
    for (const Pond& pond : layout_.ponds) {
      if ((p - pond.centre).norm() < pond.radius_m + 0.5) return covers_.mud;
    }
    if (is_beside_building(p)) return covers_.shoulder;
    for (const Plot* plot : plots) {
      if (plot->rect.distance_m(p) == 0) return plot->surface;
    }
    return natural_at(p);
  }

 private:
  /// A road or its shoulder.
  std::optional<std::uint16_t> road_at(const Eigen::Vector2d& p) const {
    double nearest_m = 1e9;
    for (const Road& road : layout_.roads) {
      const double distance_m = (p - road.line.nearest(p)).norm() - 0.5 * road.width_m;
      if (distance_m < 0) return road.surface;
      nearest_m = std::min(nearest_m, distance_m);
    }
    if (nearest_m < shoulder_m_) return covers_.shoulder;
    return std::nullopt;
  }

  bool is_beside_building(const Eigen::Vector2d& p) const {
    return std::any_of(
        layout_.building_grounds.begin(), layout_.building_grounds.end(), [&](const Levelling& ground) {
          const GroundRect& walls = ground.rect;
          return (p - walls.centre).cwiseAbs().maxCoeff() < walls.half_u_m + walls.half_v_m + 1 &&
                 walls.distance_m(p) < 0.8;
        });
  }

  std::uint16_t natural_at(const Eigen::Vector2d& p) const {
    const auto blotches = [&](double wavelength_m, std::uint32_t salt) {
      return value_noise(p.x() / wavelength_m, p.y() / wavelength_m, seed_ + salt) +
             0.5 * value_noise(p.x() / wavelength_m * 3.7, p.y() / wavelength_m * 3.7, seed_ + salt + 1) +
             0.3 * value_noise(p.x() / wavelength_m * 13.1, p.y() / wavelength_m * 13.1, seed_ + salt + 2);
    };
    if (blotches(9, 0) > 0.75) return covers_.patches;
    return blotches(15, 10) > 0.25 ? covers_.ground_alt : covers_.ground;
  }

  const SiteLayout& layout_;
  const CoverSurfaces& covers_;
  std::uint32_t seed_;
  double shoulder_m_ = 0;
};

}  // namespace

CoverSurfaces add_cover_surfaces(const WorldSpec& spec, SurfaceTable& surfaces) {
  const LookParameters& look = spec.look();
  CoverSurfaces covers;
  covers.ground = surfaces.add(spec.cover(look.ground));
  covers.ground_alt = surfaces.add(spec.cover(look.ground_alt));
  covers.patches = surfaces.add(spec.cover(look.patches));
  covers.shoulder = surfaces.add(look.road_net == RoadNet::kGrid ? Material::kPaving : Material::kGravel);
  covers.mud = surfaces.add(Material::kSoil, {0.6F, 0.6F, 0.6F});
  return covers;
}

void paint_ground(const WorldSpec& spec, const SiteLayout& layout, const CoverSurfaces& covers,
                  Terrain& terrain) {
  const CoverMap cover(spec, layout, covers);
  parallel_rows(0, terrain.cover_size(), [&](int row) {
    std::vector<const Plot*> plots;
    for (const Plot& plot : layout.plots) {
      const double reach_m = std::hypot(plot.rect.half_u_m, plot.rect.half_v_m);
      if (std::abs(terrain.cover_axis_m(row) - plot.rect.centre.y()) <= reach_m) plots.push_back(&plot);
    }
    for (int column = 0; column < terrain.cover_size(); ++column) {
      terrain.cover_cell(row, column) =
          cover.at({terrain.cover_axis_m(column), terrain.cover_axis_m(row)}, plots);
    }
  });
  terrain.find_cover_borders();
}

}  // namespace alight::sim
