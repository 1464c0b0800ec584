#pragma once

#include "calibrate/clocks/edge_agreement.hpp"
#include "calibrate/clocks/turn_search.hpp"
#include "calibrate/fitting/rigid_motion.hpp"
#include "foundation/binder_fwd.hpp"

namespace alight {

/// How the LiDAR's extrinsics are searched for around the rig's.
struct EdgeCheckConfig {
  double window_s = 0.5;    ///< LiDAR edges measured within half of it of an image are held against it
  double max_turn_deg = 2;  ///< searched about each axis
  int min_edges = 400;      ///< fewer say nothing
  double min_stands_out =
      kStandsOut;  ///< the best score over those away from it, in their standard deviations
};
void bind(Binder& b, EdgeCheckConfig& c);

/// One kind of motion (turn in rad, or shift in m, in the left camera's frame) that would better the agreement.
struct Betterment {
  bool found = false;  ///< the agreement has a maximum nearby
  Eigen::Vector3d by = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();
};

/// The LiDAR's depth edges against the edges of the left camera's images.
struct EdgeCheck {
  int edges = 0;
  int views = 0;
  double score = 0;       ///< at the rig's extrinsics, 1 is no better than elsewhere in the images
  double best_score = 0;  ///< after the turn
  double chance = 0;      ///< the mean of the search away from the best
  double stands_out = 0;  ///< (best - chance) over the standard deviation of those
  bool peak = false;      ///< stands out enough to say anything
  Betterment turn;        ///< T_cam_lidar = Exp(turn) * (the rig's), shift held
  Betterment shift;       ///< and what a shift would add to that turn
};

/// Searches for the turns and shifts of the LiDAR at which depth edges and image edges agree best.
EdgeCheck check_edges(const EdgeAgreement& agreement, const EdgeCheckConfig& config);

/// exp(turn) about the camera's origin, then the shift.
Eigen::Isometry3d motion_of(const Eigen::Vector3d& turn_rad, const Eigen::Vector3d& shift_m);

}  // namespace alight
