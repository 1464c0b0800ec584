#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "sim/random.hpp"
#include "sim/site/site_layout.hpp"

namespace alight::sim {

/// Ground where nothing stands, |x|, |y| <= half_width_m; a quarter of the places, if there are clearings, lies in one of
/// them, which are kept free of everything else.
/// @param radius_m of the ground that has to be free
/// @returns its middle, or nothing where none was found
std::optional<Eigen::Vector2d> find_open(const SitePlan& plan, const std::vector<Levelling>& clearings,
                                         Random& random, double radius_m, double half_width_m);

}  // namespace alight::sim
