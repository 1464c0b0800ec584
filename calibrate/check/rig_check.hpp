#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "calibrate/check/edge_check.hpp"
#include "calibrate/check/stereo_agreement.hpp"
#include "calibrate/clocks/flight_views.hpp"

namespace alight {

/// `alight-calibrate check`.
struct RigCheckConfig {
  LogConfig log;
  FlightViewsConfig views;
  EdgeCheckConfig edges;
  double stereo_window_s =
      0.2;  ///< LiDAR points measured within half of it of an image compare the two cameras
  int min_stereo_points = 300;  ///< fewer say nothing
  double min_stereo_explained =
      0.5;  ///< of these points; where no turn explains so many, the cameras do not look at the same
  double moved_turn_deg =
      0.2;  ///< the LiDAR has moved where a turn by more betters the agreement: about x and y
  double moved_roll_deg = 0.3;  ///< and about the camera's optical axis, which edges tell less well
  double moved_shift_m = 0.1;   ///< or a shift
  double moved_eye_deg = 0.05;  ///< and the right camera where one of its turns does
  double moved_sigmas = 4;      ///< and by more than so many standard deviations
};
void bind(Binder& b, RigCheckConfig& c);

enum class RigVerdict { kGood, kMoved, kCannotTell };
/// "good", "moved", "cannot tell"
const char* name(RigVerdict verdict);

/// One axis of a sensor's extrinsics.
struct AxisCheck {
  std::string name;    ///< "LiDAR turn about x"
  std::string unit;    ///< "deg", "m"
  bool found = false;  ///< the agreement has a maximum that stands out; else `by` and `sigma` mean nothing
  double by = 0;       ///< what would better the agreement
  double sigma = 0;
  double noticed_from =
      0;  ///< a motion by more counts as moved: the limit, or what the log can tell where that is more
  bool judged = false;  ///< noticed_from is not far above the limit
  bool moved = false;
};

/// The outcome of a check.
struct RigCheck {
  RigVerdict verdict = RigVerdict::kCannotTell;
  std::vector<std::string> reasons;  ///< why it cannot tell, or what has moved
  EdgeCheck edges;
  StereoAgreement stereo;
  bool has_right = false;
  std::vector<AxisCheck> axes;  ///< six of the LiDAR, and three of the right camera where there is one
};

/// Whether LiDAR and cameras are still mounted as the rig says, from a flight: no board is needed. Axes are those of the
/// rectified left camera (x right, y down, z forward), for the right camera those of the rectified right one.
RigCheck check_rig(const FlightViews& flight, const RigCheckConfig& config);

/// The flight's depth edges and images, ready to be held against each other.
EdgeAgreement edge_agreement_of(const FlightViews& flight, const EdgeCheckConfig& config);

}  // namespace alight
