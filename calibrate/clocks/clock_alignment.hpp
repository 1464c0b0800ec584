#pragma once

#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "calibrate/clocks/flight_views.hpp"
#include "foundation/binder_fwd.hpp"

namespace alight {

/// `alight-dataset align`.
struct ClockAlignmentConfig {
  LogConfig log;
  FlightViewsConfig views;
  double max_offset_s = 0.15;  ///< searched to either side of what the rig says
  double smooth_s = 0.1;       ///< poses are averaged over so long to either side: attitudes are noisy
  double points_window_s =
      0.2;  ///< LiDAR points measured within half of it of an image are followed to the next one
  double edges_window_s = 0.5;   ///< LiDAR edges measured within half of it of an image are held against it
  double max_sigma_s = 0.004;    ///< an offset that is less certain is none
  int min_pairs = 8;             ///< images with enough texture for the camera's offset
  double min_followed = 0.5;     ///< share of the images that are followed to the next one
  double min_correlation = 0.7;  ///< of the turns by images and by poses
  int min_edges = 400;           ///< depth edges for the LiDAR's offset
};
void bind(Binder& b, ClockAlignmentConfig& c);

/// One sensor's clock against the poses'.
struct ClockOffset {
  bool told = false;
  std::string reason;   ///< why not
  double offset_s = 0;  ///< t_pose = t_sensor + offset, on top of the rig's time shift
  double sigma_s = 0;
  std::vector<std::pair<double, double>> scores;  ///< offset [s] -> score, over the searched range
};

/// How the camera turned between two of its images, in its own frame.
struct ViewTurn {
  double t_s = 0;                                       ///< half-way, from the first image on
  Eigen::Vector3d seen_rad = Eigen::Vector3d::Zero();   ///< by the images
  Eigen::Vector3d posed_rad = Eigen::Vector3d::Zero();  ///< by the poses, at the offset that was found
};

/// The outcome for a log: how far its clocks are off, in seconds, and how sure that is.
struct ClockAlignment {
  ClockOffset camera;
  double correlation = 0;  ///< of the turns by images and by poses, at the camera's offset
  ClockOffset lidar;
  double stands_out = 0;  ///< of the depth edges' agreement (TurnSearch), at the LiDAR's offset
  std::vector<ViewTurn> turns;
};

/// Both offsets from a flight. The camera's: patches at LiDAR points are followed from image to image; poses that are shifted
/// by the right offset predict where they go, and the turn that is left over is least. The LiDAR's: with the right offset its
/// depth edges, carried to the images by the vehicle's motion, lie on image edges. Either needs motion that changes.
ClockAlignment align_clocks(const FlightViews& flight, const ClockAlignmentConfig& config);

}  // namespace alight
