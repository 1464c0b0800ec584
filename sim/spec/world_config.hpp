#pragma once

#include <optional>
#include <string>
#include <vector>

#include "foundation/binder_fwd.hpp"
#include "sim/spec/hardship.hpp"

namespace alight::sim {

/// Kinds of places.
enum class Look { kVillage, kForest, kFarmland, kRocky, kUrban };

enum class VisitorKind { kNone, kCar, kPerson };

/// Something that comes to a place while a vehicle may be landing there.
struct VisitorConfig {
  VisitorKind kind = VisitorKind::kNone;
  double from_x_m = 0;
  double from_y_m = 0;
  double to_x_m = 0;
  double to_y_m = 0;
  double begin_s = 0;  ///< sets out, from the start of the flight
  double speed_mps = 5;
};
void bind(Binder& b, VisitorConfig& c);

/// What to build. The same values give the same world, bit for bit.
struct WorldConfig {
  Look look = Look::kVillage;
  int seed = 1;
  double size_m = 160;                      ///< side of the square that is built in detail
  std::optional<double> sun_elevation_deg;  ///< none: drawn from the seed
  std::optional<double> sun_azimuth_deg;    ///< counter-clockwise from east; none: drawn from the seed
  Hardships hard;                           ///< none by default
  VisitorConfig visitor;
};
void bind(Binder& b, WorldConfig& c);
/// The look's name in YAML.
std::string to_string(Look look);
/// Every look, in the order of the enumeration.
std::vector<Look> all_looks();

}  // namespace alight::sim
