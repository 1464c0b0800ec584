#pragma once

#include <vector>

#include <Eigen/Core>

#include "sensors/messages/message_types.hpp"

namespace alight {

/// A beam that ended on the board.
struct Beam {
  Eigen::Vector3d direction;  ///< unit, LiDAR's frame
  double range_m;
  double level;  ///< reflectivity
};

/// normal . p = distance, in the LiDAR's frame.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< unit
  double distance_m = 0;

  /// Where a beam meets it.
  double range(const Eigen::Vector3d& direction) const { return distance_m / normal.dot(direction); }
};

/// At most 40,000 of the points, evenly thinned: more bring nothing that a calibration could still see.
std::vector<Beam> beams_of(const std::vector<LidarReturn>& points);

/// RANSAC over triples in a fixed pseudo-random order, then least squares over the inliers, twice.
/// @param inliers filled: one for each beam, not 0 within 6 cm of the plane, three times the noise of a Livox
Plane ransac_plane(const std::vector<Beam>& beams, std::vector<char>& inliers);

}  // namespace alight
