#pragma once

#include <Eigen/Core>

#include "sim/render/renderer.hpp"
#include "sim/truth/surface_truth.hpp"

namespace alight::closed_loop {

/// Highest surface inside a circle, of what stood there at the truth's time.
double highest_m(const sim::SurfaceTruth& truth, const Eigen::Vector2d& middle, double radius_m);

/// Whether something below a disc of `radius_m` around p_world reaches up to `low_m` at a time.
bool reached_from_below(const sim::Renderer& renderer, const Eigen::Vector3d& p_world, double radius_m,
                        double low_m, double t_s);

}  // namespace alight::closed_loop
