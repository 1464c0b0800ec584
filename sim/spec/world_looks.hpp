#pragma once

#include <array>

#include "sim/objects/material.hpp"
#include "sim/spec/world_config.hpp"

namespace alight::sim {

/// How roads run.
enum class RoadNet { kNone, kTrack, kCross, kGrid };

/// One octave of the relief.
struct ReliefOctave {
  double wavelength_m;
  double amplitude_m;
};

/// What makes a look: one row of the table in world_looks.cpp. Counts are for a square of 160 m.
struct LookParameters {
  std::array<ReliefOctave, 4> relief;  ///< coarse to fine; roads follow the first alone
  int mounds;
  double mound_height_m;
  Material ground;
  Material ground_alt;
  Material patches;
  RoadNet road_net;
  Material road;
  double road_width_m;
  int buildings;
  double flat_roof_share;
  int min_storeys;
  int max_storeys;
  bool barns;
  bool fields;
  int ponds;
  int clearings;  ///< level open ground, 4 m to 8 m in radius
  int trees;
  double conifer_share;
  double min_tree_m;
  double max_tree_m;
  int bushes;
  int tufts;
  int boulders;
  double max_boulder_m;
  int cars;
  int lamps;
  int bales;
  bool power_line;
};

/// The row of a look.
const LookParameters& parameters(Look look);

}  // namespace alight::sim
