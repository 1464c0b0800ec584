#include "sim/spec/world_looks.hpp"

namespace alight::sim {
namespace {

LookParameters village() {
  LookParameters p{};
  p.relief = {{{70, 2.2}, {22, 0.5}, {6, 0.10}, {2, 0.025}}};
  p.mounds = 3, p.mound_height_m = 2.5;
  p.ground = Material::kGrass, p.ground_alt = Material::kDryGrass, p.patches = Material::kSoil;
  p.road_net = RoadNet::kCross, p.road = Material::kAsphalt, p.road_width_m = 6;
  p.buildings = 26, p.flat_roof_share = 0.12, p.min_storeys = 1, p.max_storeys = 2;
  p.ponds = 1, p.clearings = 5;
  p.trees = 75, p.conifer_share = 0.25, p.min_tree_m = 4, p.max_tree_m = 12;
  p.bushes = 110, p.tufts = 260, p.boulders = 25, p.max_boulder_m = 0.5;
  p.cars = 16, p.lamps = 8, p.power_line = true;
  return p;
}

LookParameters forest() {
  LookParameters p{};
  p.relief = {{{60, 3.5}, {18, 1.0}, {6, 0.22}, {2, 0.04}}};
  p.mounds = 6, p.mound_height_m = 3;
  p.ground = Material::kDryGrass, p.ground_alt = Material::kSoil, p.patches = Material::kGrass;
  p.road_net = RoadNet::kTrack, p.road = Material::kGravel, p.road_width_m = 3.2;
  p.buildings = 1, p.min_storeys = 1, p.max_storeys = 1, p.barns = true;
  p.ponds = 1, p.clearings = 8;
  p.trees = 560, p.conifer_share = 0.55, p.min_tree_m = 6, p.max_tree_m = 18;
  p.bushes = 260, p.tufts = 500, p.boulders = 70, p.max_boulder_m = 0.9;
  p.cars = 1;
  return p;
}

LookParameters farmland() {
  LookParameters p{};
  p.relief = {{{90, 2.6}, {30, 0.5}, {7, 0.07}, {2, 0.02}}};
  p.mounds = 4, p.mound_height_m = 2.5;
  p.ground = Material::kGrass, p.ground_alt = Material::kDryGrass, p.patches = Material::kGrass;
  p.road_net = RoadNet::kTrack, p.road = Material::kGravel, p.road_width_m = 3.5;
  p.buildings = 4, p.min_storeys = 1, p.max_storeys = 2, p.barns = true;
  p.fields = true, p.ponds = 1, p.clearings = 6;
  p.trees = 40, p.conifer_share = 0.1, p.min_tree_m = 5, p.max_tree_m = 13;
  p.bushes = 90, p.tufts = 320, p.boulders = 20, p.max_boulder_m = 0.5;
  p.cars = 2, p.bales = 26, p.power_line = true;
  return p;
}

LookParameters rocky() {
  LookParameters p{};
  p.relief = {{{50, 4.0}, {18, 1.5}, {6, 0.40}, {2, 0.07}}};
  p.mounds = 8, p.mound_height_m = 4;
  p.ground = Material::kGravel, p.ground_alt = Material::kRock, p.patches = Material::kDryGrass;
  p.road_net = RoadNet::kNone, p.road = Material::kGravel, p.road_width_m = 3;
  p.ponds = 1, p.clearings = 8;
  p.trees = 18, p.conifer_share = 0.8, p.min_tree_m = 2.5, p.max_tree_m = 7;
  p.bushes = 110, p.tufts = 300, p.boulders = 620, p.max_boulder_m = 2.2;
  return p;
}

LookParameters urban() {
  LookParameters p{};
  p.relief = {{{120, 0.9}, {40, 0.12}, {8, 0.03}, {2, 0.012}}};
  p.mounds = 4, p.mound_height_m = 2.0;
  p.ground = Material::kPaving, p.ground_alt = Material::kConcrete, p.patches = Material::kGrass;
  p.road_net = RoadNet::kGrid, p.road = Material::kAsphalt, p.road_width_m = 8;
  p.buildings = 26, p.flat_roof_share = 0.8, p.min_storeys = 2, p.max_storeys = 6;
  p.ponds = 1, p.clearings = 6;
  p.trees = 80, p.conifer_share = 0.05, p.min_tree_m = 5, p.max_tree_m = 10;
  p.bushes = 70, p.tufts = 40, p.boulders = 6, p.max_boulder_m = 0.5;
  p.cars = 55, p.lamps = 26;
  return p;
}

}  // namespace

const LookParameters& parameters(Look look) {
  static const std::array<LookParameters, 5> kTable = {village(), forest(), farmland(), rocky(), urban()};
  return kTable[static_cast<std::size_t>(look)];
}

}  // namespace alight::sim
