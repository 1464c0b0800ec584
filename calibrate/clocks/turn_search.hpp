#pragma once

#include <Eigen/Geometry>

#include "calibrate/clocks/edge_agreement.hpp"

namespace alight {

/// How the agreement of depth edges changes with the LiDAR's orientation.
struct TurnSearch {
  Eigen::Vector3d best_rad =
      Eigen::Vector3d::Zero();  ///< rotation vector, camera frame, to the precision of the grid
  double best = 0;              ///< score there
  double chance = 0;            ///< mean score away from it
  double stands_out = 0;        ///< (best - chance) over the standard deviation of the scores away from it
};

/// Edges held against images that they have nothing to do with stood out by up to 4.6 of 36 times; what stands out by more than
/// this has to do with them.
constexpr double kStandsOut = 5.0;

/// Tries all turns on a grid of 0.15 deg (0.5 about the optical axis). How far the best stands out (peak to side lobes) says
/// whether the edges have anything to do with the images at all. @param reach_deg about each axis, 1.5 or more
TurnSearch search_turns(const EdgeAgreement& agreement, double reach_deg);

/// A turn about the camera's origin by a rotation vector.
Eigen::Isometry3d turn_about_camera(const Eigen::Vector3d& turn_rad);

}  // namespace alight
