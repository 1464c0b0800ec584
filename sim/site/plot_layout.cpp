#include "sim/site/plot_layout.hpp"

#include "sim/site/road_layout.hpp"

namespace alight::sim {
namespace {

/// Borders from one end of the site to the other, min_m to max_m apart.
std::vector<double> field_borders(double size_m, Random& random, double min_m, double max_m) {
  std::vector<double> borders = {-0.8 * size_m};
  while (borders.back() < 0.8 * size_m) borders.push_back(borders.back() + random.uniform(min_m, max_m));
  return borders;
}

/// A field's crop, cover and colour.
void sow(const WorldSpec& spec, Random& random, SurfaceTable& surfaces, Plot& field) {
  const double kind = random.uniform();
  field.crop_rows = kind < 0.32;
  const bool bare = kind < 0.55;
  const bool stubble = kind < 0.8;
  const Material material = bare ? Material::kSoil : (stubble ? Material::kDryGrass : Material::kGrass);
  const float shade = random.uniformf(0.8, 1.25);
  const Eigen::Vector3f tint = {shade * random.uniformf(0.9, 1.1), shade, shade};
  field.surface = surfaces.add_framed(spec.cover(material), field.rect.centre, field.rect.u_axis,
                                      bare ? 0.75 : 0.0, tint);
}

void lay_fields(const WorldSpec& spec, Random& random, SurfaceTable& surfaces, SiteLayout& layout) {
  constexpr double kBalk_m = 2.2;  // grass between two fields
  const std::vector<double> u = field_borders(spec.size_m(), random, 24, 46);
  const std::vector<double> v = field_borders(spec.size_m(), random, 24, 46);
  const Eigen::Vector2d u_axis = heading(layout.yaw_rad);
  const Eigen::Vector2d v_axis = left_of(u_axis);
  for (std::size_t i = 0; i + 1 < u.size(); ++i) {
    for (std::size_t k = 0; k + 1 < v.size(); ++k) {
      Plot field;
      field.rect.centre = u_axis * (0.5 * (u[i] + u[i + 1])) + v_axis * (0.5 * (v[k] + v[k + 1]));
      field.rect.half_u_m = 0.5 * (u[i + 1] - u[i]) - 0.5 * kBalk_m;
      field.rect.half_v_m = 0.5 * (v[k + 1] - v[k]) - 0.5 * kBalk_m;
      field.rect.u_axis = u_axis;
      sow(spec, random, surfaces, field);
      layout.plots.push_back(field);
    }
  }
}

void lay_blocks(const WorldSpec& spec, Random& random, SurfaceTable& surfaces, SiteLayout& layout) {
  const std::vector<Material> kinds = {Material::kGrass, Material::kGrass, Material::kPaving,
                                       Material::kAsphalt, Material::kGravel};
  const std::vector<Road>& roads = layout.roads;
  const std::size_t per_direction = roads.size() / 2;
  for (std::size_t i = 0; i < per_direction; ++i) {
    for (std::size_t k = 0; k < per_direction; ++k) {
      // The two directions of a grid take turns; a block lies half a step beyond each.
      const Eigen::Vector2d u_axis = roads[0].line.direction();
      const Eigen::Vector2d v_axis = roads[1].line.direction();
      const Eigen::Vector2d street = 0.5 * (roads[2 * i].line.a + roads[2 * i].line.b);
      const Eigen::Vector2d cross_street = 0.5 * (roads[2 * k + 1].line.a + roads[2 * k + 1].line.b);
      Plot block;
      const Eigen::Vector2d centre = street + cross_street + (u_axis + v_axis) * (0.5 * kBlock_m);
      block.rect = {centre, 0.5 * kBlock_m, 0.5 * kBlock_m, u_axis};
      block.surface = surfaces.add_framed(spec.cover(random.pick(kinds)), block.rect.centre, u_axis, 0.0);
      layout.plots.push_back(block);
    }
  }
}

}  // namespace

void lay_plots(const WorldSpec& spec, SurfaceTable& surfaces, SiteLayout& layout) {
  Random random = spec.stream(BuildStep::kPlots);
  if (spec.look().fields) lay_fields(spec, random, surfaces, layout);
  if (spec.look().road_net == RoadNet::kGrid) lay_blocks(spec, random, surfaces, layout);
}

}  // namespace alight::sim
