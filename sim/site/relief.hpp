#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "sim/spec/world_looks.hpp"

namespace alight::sim {

/// The natural ground of a site, without anything that people or mounds made of it. Heights in metres, above a level
/// of its own: the world's origin is put on the ground later.
class Relief {
 public:
  Relief(const std::array<ReliefOctave, 4>& octaves, int seed);

  /// The first octave alone, which roads and level ground follow.
  double smooth_m(const Eigen::Vector2d& p) const;
  /// All octaves.
  double height_m(const Eigen::Vector2d& p) const;

 private:
  std::array<ReliefOctave, 4> octaves_;
  std::uint32_t seed_;
};

}  // namespace alight::sim
