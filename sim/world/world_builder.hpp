#pragma once

#include <optional>
#include <vector>

#include "sim/objects/props.hpp"
#include "sim/objects/site_plan.hpp"
#include "sim/objects/terrain_mesh.hpp"
#include "sim/objects/triangle_mesh.hpp"
#include "sim/random.hpp"
#include "sim/spec/world_looks.hpp"
#include "sim/world/world.hpp"

namespace alight::sim {

/// Lays out a place on paper first (roads, fields, clearings, ponds, buildings), then shapes the ground to
/// the layout, paints it and puts everything on it. Each step draws from a random stream of its own, so that
/// a change in one leaves the others as they were.
class WorldBuilder {
 public:
  explicit WorldBuilder(const WorldConfig& config);

  /// Does everything; call once, then take the results.
  void build();

  std::vector<TriangleMesh> meshes;
  std::vector<Placement> placements;
  std::vector<Surface> surfaces;
  std::vector<Mover> movers;
  std::optional<Terrain> terrain;

 private:
  struct Road {
    GroundSegment line;
    double width_m = 0;
    std::uint16_t surface = 0;
  };
  /// A field or a city block: a cover of its own, perhaps rows of plants.
  struct Area {
    GroundRect rect;
    std::uint16_t surface = 0;
    bool crop_rows = false;
  };
  /// Ground made level (or evenly sloped) on a rectangle with round corners, blending into the relief around
  /// it.
  struct Levelling {
    GroundRect rect;
    double margin_m = 0;
    double falloff_m = 3;
    double height_m = 0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  };
  struct Pond {
    Eigen::Vector2d centre;
    double radius_m = 0;
    double level_m = 0;
  };
  struct Mound {
    Eigen::Vector2d centre;
    double sigma_m = 0;
    double height_m = 0;
  };

  // Layout.
  void lay_roads();
  void add_road(const Eigen::Vector2d& through, double yaw_rad);
  void lay_areas();
  void lay_blocks(Random& random);
  void lay_fields(Random& random);
  void lay_clearings();
  std::optional<Eigen::Vector2d> find_clearing(Random& random, double radius_m, double half_width_m) const;
  void lay_ponds();
  void lay_buildings();
  void lay_mounds();
  std::vector<double> grid_lines(Random& random, double min_m, double max_m) const;

  // Ground.
  double smooth_relief_m(const Eigen::Vector2d& p) const;
  double relief_m(const Eigen::Vector2d& p) const;
  double shaped_height_m(const Eigen::Vector2d& p) const;
  void shape_ground();
  void paint_ground();
  std::uint16_t natural_cover(const Eigen::Vector2d& p) const;
  std::uint16_t cover_at(const Eigen::Vector2d& p, const std::vector<const Area*>& areas) const;

  // Things on the ground.
  void raise_buildings();
  void add_water();
  void add_kerbs();
  void grow_crops();
  void grow_crop_row(const Area& area, double v_m, std::uint16_t surface, Random& random);
  void plant_trees();
  void plant_small();
  std::vector<std::size_t> boulder_kinds(Random& random, int count, double max_shade);
  void scatter_boulders();
  PropSurfaces car_surfaces();
  void park_cars();
  void set_lamps_and_bales();
  void string_power_line();

  // What makes it hard.
  void add_hardships();
  void string_wires();
  void lay_beds();
  void scatter_stones();
  Material ground_cover(Material material) const;
  std::optional<Eigen::Vector2d> find_open(Random& random, double radius_m) const;

  // What moves.
  void add_movers();
  void add_traffic();
  void add_people();
  void add_visitor();
  Mover on_way(std::size_t mesh, const Eigen::Vector3f& tint, const Eigen::Vector2d& from,
               const Eigen::Vector2d& to) const;

  std::uint16_t add_surface(Material material, const Eigen::Vector3f& tint = Eigen::Vector3f::Ones());
  std::uint16_t add_framed_surface(Material material, const Eigen::Vector2d& origin,
                                   const Eigen::Vector2d& u_axis, double width_m);
  void scatter(Random& random, const std::vector<std::size_t>& kinds, int count, double min_scale,
               double max_scale, double clear_radius, bool keep, double sink);
  std::size_t add_mesh(TriangleMesh mesh);
  void put(std::size_t mesh, const Eigen::Vector2d& at, double sink_m, double yaw_rad, double scale,
           const Eigen::Vector3f& tint = Eigen::Vector3f::Ones());
  Eigen::Vector3f on_ground(const Eigen::Vector2d& p) const;
  Random stream(std::uint64_t step) const;
  int scaled(int count) const;
  double half_m() const { return 0.5 * config_.size_m; }

  WorldConfig config_;
  const LookParameters& look_;
  SitePlan plan_;
  double yaw_rad_ = 0;  // of the roads and fields
  std::vector<Road> roads_;
  std::vector<Area> areas_;
  std::vector<Levelling> levellings_;
  std::vector<std::size_t> clearings_;  // which of the levellings are clearings
  std::vector<Pond> ponds_;
  std::vector<Mound> mounds_;
  std::vector<GroundRect> building_rects_;
  TriangleMesh fixed_;  // everything that stands once
  std::uint16_t ground_ = 0;
  std::uint16_t ground_alt_ = 0;
  std::uint16_t patches_ = 0;
  std::uint16_t shoulder_ = 0;
  std::uint16_t mud_ = 0;
};

}  // namespace alight::sim
