#include "infer/health/health_config.hpp"

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, CameraHealthConfig& c) {
  b.field("black_level", c.black_level, "a darker mean is black, grey levels", between(0, 255));
  b.field("saturated_level", c.saturated_level, "brighter pixels hold no texture, grey levels",
          between(1, 255));
  b.field("max_saturated_share", c.max_saturated_share, "of such pixels; more is over-exposed",
          between(0, 1));
  b.field("frozen_difference", c.frozen_difference, "pictures that differ less are one, mean grey levels",
          between(0, 255));
  b.field("frozen_move_m", c.frozen_move_m, "a picture that never changed is frozen after this way",
          between(0.01, 1000));
}

void bind(Binder& b, StereoHealthConfig& c) {
  b.field("window_px", c.window_px, "side of the square in which the cameras are compared",
          between(32, 4096));
  b.field("period_s", c.period_s, "between two comparisons of the cameras", between(0, 10));
  b.field("min_response", c.min_response, "phase correlation below it says nothing", between(0, 1));
  b.field("max_misalignment_px", c.max_misalignment_px,
          "between the cameras' shift and the expected disparity", between(0.1, 100));
  b.field("min_disparity_px", c.min_disparity_px, "with less, swapped cameras are not told from right ones",
          between(0.1, 100));
}

void bind(Binder& b, LidarHealthConfig& c) {
  b.field("min_point_share", c.min_point_share, "of a packet's usual points; less is a partial loss",
          between(0, 1));
  b.field("max_spike_share", c.max_spike_share, "of echoes alone in front of both neighbours; more is noise",
          between(0, 1));
  b.field("spike_m", c.spike_m, "how far in front", between(0.01, 100));
  b.field("spike_relative", c.spike_relative, "and by which share of the range", between(0, 1));
  b.field("memory_s", c.memory_s, "LiDAR of the past that a packet has to agree with", between(0.1, 60));
  b.field("cell_m", c.cell_m, "ground cells in which heights are compared", between(0.05, 10));
  b.field("min_cells", c.min_cells, "fewer cells in common say nothing", at_least(1));
  b.field("max_misfit_m", c.max_misfit_m, "mean height difference there; more contradicts the pose",
          between(0.01, 100));
  b.field("mirror_misfit_m", c.mirror_misfit_m, "difference from which on mirrored echoes are tried",
          between(0.01, 100));
  b.field("mirror_gain", c.mirror_gain, "share of the difference left when mirrored; less is a mirror",
          between(0, 1));
}

void bind(Binder& b, PoseHealthConfig& c) {
  b.field("max_position_step_m", c.max_position_step_m, "off the way so far; more is a jump",
          between(0.01, 1000));
  b.field("max_turn_deg", c.max_turn_deg, "between two attitudes 20 ms apart; more is a jump",
          between(0.1, 180));
  b.field("frozen_s", c.frozen_s, "the same value for so long is frozen, if it used to vary",
          between(0.01, 60));
}

void bind(Binder& b, HealthConfig& c) {
  b.field("lost_after_s", c.lost_after_s, "silence after which a sensor is lost, at least 2.5 periods",
          between(0.01, 60));
  b.field("start_s", c.start_s, "a sensor that has not spoken by then is lost", between(0, 600));
  b.field("confirm_s", c.confirm_s, "from the first sign of a fault to the finding", between(0, 10));
  b.field("recover_s", c.recover_s, "without a sign, then the finding ends", between(0, 600));
  b.field("max_ahead_s", c.max_ahead_s, "stamp later than the other sensors'; more is a clock jump",
          between(0.001, 60));
  b.field("max_behind_s", c.max_behind_s, "stamp earlier than the other sensors'; more is a clock jump",
          between(0.001, 60));
  b.field("max_disorder_share", c.max_disorder_share, "of messages older than the one before", between(0, 1));
  b.section("camera", c.camera, "when a picture is no picture");
  b.section("stereo", c.stereo, "when the cameras do not belong together");
  b.section("lidar", c.lidar, "when echoes are not of the surroundings");
  b.section("pose", c.pose, "when the pose cannot be true");
}

}  // namespace alight
