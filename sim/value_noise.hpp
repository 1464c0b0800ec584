#pragma once

#include <cstdint>

namespace alight::sim {

/// Smooth noise in [-1, 1] with one knot every unit.
double value_noise(double x, double y, std::uint32_t seed);

}  // namespace alight::sim
