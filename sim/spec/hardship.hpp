#pragma once

#include <string>
#include <vector>

namespace alight::sim {

/// What makes a place harder to land in than its look alone.
enum class Hardship {
  kStones,     ///< stones of 20 to 30 cm across the open ground
  kKerbs,      ///< beds with stone edging of 10 to 15 cm in open ground
  kWires,      ///< two lines of masts and wires across open ground, away from roads
  kSlopes,     ///< open ground leans by 6 to 14 deg, around what a vehicle stands on
  kClearings,  ///< level open ground is small, 2.2 to 4 m in radius, and there is more of it
  kSnow,       ///< natural ground is white and nearly without texture
  kDusk,       ///< the sun a few degrees high, a fifth of a day's light
  kTraffic,    ///< cars drive along the roads, where there are any
  kPeople      ///< people walk to and fro over open ground
};

/// The hardship's name in YAML.
std::string to_string(Hardship hardship);
/// Every hardship, in the order of the enumeration.
std::vector<Hardship> all_hardships();
/// Their names, comma-separated.
std::string hardship_names();

/// Which hardships a world has; written as a list of names.
struct Hardships {
  std::vector<std::string> names;
  bool has(Hardship hardship) const;
  /// The first name that is none; empty if all are.
  std::string unknown() const;
};

}  // namespace alight::sim
