#pragma once

#include <filesystem>
#include <memory>

#include "geometry/rig/rig.hpp"
#include "infer/depth/landing_pipeline.hpp"
#include "sim/record/fault_injector.hpp"
#include "sim/record/simulated_flight.hpp"

namespace alight {

/// A short simulated flight: its messages as they were recorded, and what is true of its ground.
class SimulatedTruth {
 public:
  /// Flies, records to `folder` and reads it back.
  explicit SimulatedTruth(const std::filesystem::path& folder);

  const Rig& rig() const { return rig_; }
  const sim::Messages& messages() const { return messages_; }
  /// True time of the flight's begin, on the messages' clock.
  std::int64_t begin_ns() const { return begin_ns_; }

  /// Whether a frame's site is truly safe: its centre and 97 % of its circle, as `alight-sim score` counts. The site is
  /// where the vehicle, at the frame's time, would find it relative to itself: a wrong pose does not move it.
  bool is_safe(const FrameReport& frame) const;

 private:
  Rig rig_;
  std::unique_ptr<sim::SimulatedFlight> flight_;
  Eigen::Isometry3d T_camera_imu_ = Eigen::Isometry3d::Identity();
  sim::Messages messages_;
  std::int64_t begin_ns_ = 0;
};

}  // namespace alight
