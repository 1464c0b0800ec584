#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "infer/depth/landing_pipeline.hpp"
#include "infer/mission/mission_machine.hpp"
#include "sensors/poses/world_frame.hpp"

namespace alight {

/// Messages in, flight commands out: the landing pipeline, a second one of dense LiDAR alone for state 8 and below where
/// the first has a network, and the state machine over both.
///
/// `now_ns` is the receiving computer's time and the only clock; message stamps stay inside the pipelines, and how old a
/// result is comes from both, so that the computer's clock has to be on the sensors' time.
class LandingMission {
 public:
  /// @param predictor null: LiDAR alone all the way
  LandingMission(const MissionConfig& mission, const DepthEngineConfig& engine, const LandingConfig& landing,
                 const Rig& rig, std::shared_ptr<DepthPredictor> predictor);

  /// @returns the pipeline's results of this message
  std::vector<FrameReport> add(std::int64_t now_ns, const LogMessage& message);
  /// To be called at a steady rate, messages or not: time passes, and silence is noticed.
  MissionCommand step(std::int64_t now_ns);

  MissionMachine& machine() { return machine_; }
  const MissionMachine& machine() const { return machine_; }
  /// The vehicle's latest position in the world of the poses (East-North-Up, origin at the first fix).
  const std::optional<Eigen::Vector3d>& p_world() const { return p_world_; }
  const HealthReport& health() const { return health_; }

 private:
  void locate(std::int64_t now_ns, const PositionSample& sample);
  void tell(std::int64_t now_ns, const FrameReport& frame);
  bool looks_at_dense() const;

  LandingPipeline pipeline_;
  std::optional<LandingPipeline> dense_;  // with a network only; else the pipeline itself is dense LiDAR
  SiteSelector selector_;
  double full_window_s_;
  MissionMachine machine_;
  WorldFrame world_;
  std::optional<Eigen::Vector3d> p_world_;
  HealthReport health_;
  std::int64_t health_ns_ = 0;
};

}  // namespace alight
