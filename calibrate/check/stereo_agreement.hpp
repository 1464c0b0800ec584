#pragma once

#include <vector>

#include "calibrate/clocks/flight_views.hpp"
#include "calibrate/fitting/rigid_motion.hpp"

namespace alight {

/// How well both cameras see the same things at the LiDAR's points.
struct StereoAgreement {
  int points = 0;          ///< with enough texture around them to be found again
  int views = 0;           ///< that have any
  double correlation = 0;  ///< median correlation of the patches where the rig says that they are; 1 is alike
  double best_correlation = 0;  ///< and where they fit best, nearby
  double offset_px = 0;         ///< between the two, median
  double explained = 0;  ///< share of the points that the turn brings within a pixel of where they fit best
  /// What would bring them together: T_cam1_cam0 = Exp(turn) * (the rig's), in the rectified right camera's frame, with the
  /// standard deviation that the views' scatter gives.
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_rad = Eigen::Vector3d::Zero();
};

/// LiDAR points tell how far a thing is, and so at which pixels the two cameras see it: photometric agreement of the patches
/// there. Each patch is searched for around its place in the right image; one turn of the right camera that explains most
/// offsets is fitted robustly. @returns points = 0 for a mono rig
/// @param window_s LiDAR points measured within half of it of an image are used
StereoAgreement stereo_agreement(const FlightViews& flight, double window_s);

}  // namespace alight
