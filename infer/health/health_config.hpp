#pragma once

#include "foundation/binder_fwd.hpp"

namespace alight {

/// When a camera's picture is no picture.
struct CameraHealthConfig {
  double black_level = 12;           ///< grey levels of 255; a darker mean is black
  double saturated_level = 250;      ///< grey levels of 255; brighter pixels hold no texture
  double max_saturated_share = 0.5;  ///< of the pixels; more is over-exposed
  /// Grey levels of 255: a camera's own noise changes a picture by more than this from one exposure to the next.
  double frozen_difference = 0.05;
  double frozen_move_m = 0.5;  ///< a picture that never changed is frozen once the vehicle has moved so far
};
void bind(Binder& b, CameraHealthConfig& c);

/// When the two cameras do not belong together.
struct StereoHealthConfig {
  int window_px = 256;        ///< side of the compared square in the middle of the image
  double period_s = 0.1;      ///< time between two comparisons
  double min_response = 0.1;  ///< of the phase correlation, 0 to 1; below it the comparison says nothing
  double max_misalignment_px =
      1;  ///< between the measured shift of the cameras and the one that the distance asks for
  double min_disparity_px = 0.5;  ///< with less, swapped cameras cannot be told from right ones
};
void bind(Binder& b, StereoHealthConfig& c);

/// When LiDAR packets are not what the surroundings send back.
struct LidarHealthConfig {
  double min_point_share = 0.7;   ///< of the points that packets usually hold; less is a partial loss
  double max_spike_share = 0.02;  ///< of a packet's echoes that stand alone in front of both neighbours
  double spike_m = 1.0;           ///< an echo stands in front if it is nearer than both neighbours by this
  double spike_relative = 0.1;    ///< and by this share of the range
  double memory_s = 1.0;          ///< LiDAR of the past that a packet has to agree with
  double cell_m = 0.5;            ///< ground cells in which heights are compared
  int min_cells = 60;             ///< fewer cells in common say nothing
  double max_misfit_m = 0.5;  ///< mean height difference on the flat ones of those cells; more contradicts
  double mirror_misfit_m = 0.08;  ///< from here on it is asked whether the packet would fit better mirrored
  double mirror_gain = 0.5;       ///< it is mirrored if that leaves no more than this share of the difference
};
void bind(Binder& b, LidarHealthConfig& c);

/// When the vehicle's pose cannot be true.
struct PoseHealthConfig {
  double max_position_step_m = 0.5;  ///< off the place that the speed so far leads to
  double max_turn_deg = 6;           ///< between two attitudes that are no more than 20 ms apart
  /// The same value to the last bit for so long, from a sensor that used to vary. A receiver whose fixes are repeated
  /// between two of them needs more than their period.
  double frozen_s = 0.2;
};
void bind(Binder& b, PoseHealthConfig& c);

/// What every sensor is held to. All times are message times.
struct HealthConfig {
  double lost_after_s = 0.3;  ///< silence, or 2.5 usual periods of the sensor, whichever is longer
  double start_s = 1.0;       ///< a sensor that has not spoken by then is lost
  double confirm_s = 0.09;    ///< what looks wrong is not used at once, and is a finding after this time
  double recover_s = 1.0;     ///< a finding ends after this time without a sign of it
  double max_ahead_s = 0.1;   ///< a stamp later than the other sensors' by more comes from a wrong clock
  double max_behind_s = 0.3;  ///< a stamp earlier than the other sensors' by more, too
  double max_disorder_share = 0.2;  ///< of a sensor's last messages that may be older than the one before
  CameraHealthConfig camera;
  StereoHealthConfig stereo;
  LidarHealthConfig lidar;
  PoseHealthConfig pose;
};
void bind(Binder& b, HealthConfig& c);

}  // namespace alight
