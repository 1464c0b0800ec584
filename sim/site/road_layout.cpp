#include "sim/site/road_layout.hpp"

#include <cmath>

namespace alight::sim {
namespace {

void add_road(const WorldSpec& spec, const Eigen::Vector2d& through, double yaw_rad, SurfaceTable& surfaces,
              SiteLayout& layout) {
  const LookParameters& look = spec.look();
  const Eigen::Vector2d along = heading(yaw_rad);
  const double reach_m = 1.5 * spec.size_m();
  Road road;
  road.line = {through - along * reach_m, through + along * reach_m};
  road.width_m = look.road_width_m;
  const bool has_lanes = look.road == Material::kAsphalt;
  road.surface = surfaces.add_framed(look.road, road.line.a, along, has_lanes ? road.width_m : 0.0);
  layout.plan.occupy_segment(road.line, 0.5 * road.width_m + (look.road_net == RoadNet::kGrid ? 2.5 : 0.7));
  layout.roads.push_back(road);
}

}  // namespace

void lay_roads(const WorldSpec& spec, SurfaceTable& surfaces, SiteLayout& layout) {
  Random random = spec.stream(BuildStep::kRoads);
  const double offset_m = 0.16 * spec.size_m();
  const Eigen::Vector2d along = heading(layout.yaw_rad);
  const Eigen::Vector2d across = left_of(along);
  const Eigen::Vector2d off_centre = across * random.uniform(-offset_m, offset_m);
  const auto add = [&](const Eigen::Vector2d& through, double yaw_rad) {
    add_road(spec, through, yaw_rad, surfaces, layout);
  };
  switch (spec.look().road_net) {
    case RoadNet::kNone:
      break;
    case RoadNet::kTrack:
      add(off_centre, layout.yaw_rad);
      break;
    case RoadNet::kCross: {
      add(off_centre, layout.yaw_rad);
      const Eigen::Vector2d through = along * random.uniform(-offset_m, offset_m);
      add(through, layout.yaw_rad + random.uniform(1.1, 1.9));
      break;
    }
    case RoadNet::kGrid: {
      const int streets = static_cast<int>(std::ceil(0.75 * spec.size_m() / kBlock_m));
      const double shift_m = random.uniform(0, kBlock_m);
      for (int i = -streets; i <= streets; ++i) {
        add(across * (i * kBlock_m + shift_m), layout.yaw_rad);
        add(along * (i * kBlock_m + shift_m), layout.yaw_rad + kTwoPi / 4);
      }
      break;
    }
  }
}

}  // namespace alight::sim
