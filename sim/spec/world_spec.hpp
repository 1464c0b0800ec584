#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "sim/random.hpp"
#include "sim/spec/world_config.hpp"
#include "sim/spec/world_looks.hpp"

namespace alight::sim {

/// The steps in which a world is built. Each draws from a random stream of its own, which its number names, so that a
/// change in one leaves the others as they were. Another number makes every world of a seed another one.
enum class BuildStep : std::uint64_t {
  kHeading = 2,
  kRoads = 3,
  kPlots = 4,
  kClearings = 5,
  kPonds = 6,
  kBuildingGrounds = 7,
  kMounds = 8,
  kBuildings = 20,
  kPowerLine = 21,
  kLampsAndBales = 22,
  kParkedCars = 23,
  kTrees = 24,
  kBoulders = 25,
  kSmallPlants = 26,
  kCrops = 27,
  kWires = 30,
  kBeds = 31,
  kStones = 32,
  kTraffic = 33,
  kPeople = 34,
};

/// What a world is to be, as the steps of building it ask for it.
class WorldSpec {
 public:
  explicit WorldSpec(const WorldConfig& config);

  const LookParameters& look() const { return look_; }
  const VisitorConfig& visitor() const { return config_.visitor; }
  bool has(Hardship hardship) const { return config_.hard.has(hardship); }
  int seed() const { return config_.seed; }
  /// Side of the detailed square, and half of it.
  double size_m() const { return config_.size_m; }
  double half_m() const { return 0.5 * config_.size_m; }
  /// Beyond the detailed square.
  bool is_outside(const Eigen::Vector2d& p) const { return p.cwiseAbs().maxCoeff() > half_m(); }

  /// A count for a square of 160 m, by this square's area: at least one, but none of none.
  int scaled(int count) const;
  /// The cover that lies on ground of a material: snow on natural ground, where the world has snow.
  Material cover(Material material) const;
  /// The random numbers of a step, from the first.
  Random stream(BuildStep step) const;

 private:
  WorldConfig config_;
  const LookParameters& look_;
};

}  // namespace alight::sim
