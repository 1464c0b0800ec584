#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "closed_loop/landing/land_config.hpp"
#include "closed_loop/landing/landing_verdict.hpp"
#include "infer/depth/depth_predictor.hpp"
#include "sim/record/bag_writer.hpp"
#include "sim/record/fault_injector.hpp"

namespace alight::closed_loop {

/// A fault, when it strikes and for how long.
struct PlannedFault {
  const sim::Fault* fault = nullptr;
  double at_s = 0;                ///< after the flight's begin
  std::optional<double> lasts_s;  ///< none: to the end of the flight
};

/// Where the vehicle was, in the simulator's world.
struct TrackPoint {
  double t_s = 0;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  MissionState state = MissionState::kManual;
};

/// A finished landing with what its pictures show.
struct FlownLanding {
  LandingResult result;
  std::vector<TrackPoint> track;
  double fence_m = 0;
  Eigen::Vector2d fence_middle = Eigen::Vector2d::Zero();  ///< where automatic mode began
  double clock_start_s = 0;                                ///< events' times count from here
};

/// One simulated landing: a world, a multirotor in wind, rendered sensors, and the onboard program in the loop; what the
/// program commands is flown, what is flown is measured. Depends on configuration, seed, fault and network alone: no
/// clock, no threads of its own.
class LandingFlight {
 public:
  /// @throws ConfigError if the rig cannot be flown
  LandingFlight(const LandConfig& config, std::int64_t seed, std::shared_ptr<DepthPredictor> predictor,
                const PlannedFault& fault = {});
  ~LandingFlight();

  /// Flies to the end. @param bag gets every message as the sensors send it, faults not in it; null: none is kept
  FlownLanding fly(sim::BagWriter* bag = nullptr);

  /// At the start of the flight; in a world that moves, after a touchdown at its time.
  const sim::SurfaceTruth& surface_truth() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace alight::closed_loop
