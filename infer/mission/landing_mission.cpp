#include "infer/mission/landing_mission.hpp"

#include <utility>

#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr double kHealthPeriod_s = 0.1;

Place place_of(const TrackedSite& site) { return {site.p_world, site.circle.radius_m}; }

Place place_of(const LandingSite& circle, const SiteSelection& selection,
               const Eigen::Isometry3d& T_world_camera) {
  return {T_world_camera * (selection.R_level_camera.transpose() * circle.p_level), circle.radius_m};
}

}  // namespace

LandingMission::LandingMission(const MissionConfig& mission, const DepthEngineConfig& engine,
                               const LandingConfig& landing, const Rig& rig,
                               std::shared_ptr<DepthPredictor> predictor)
    : pipeline_(engine, landing, rig, predictor),
      selector_(landing.selection, pipeline_.engine().rig().intrinsics),
      full_window_s_(0.9 * engine.image.max_accumulation_s),
      machine_(mission) {
  if (predictor != nullptr) dense_.emplace(engine, landing, rig, nullptr);
}

void LandingMission::locate(std::int64_t now_ns, const PositionSample& sample) {
  p_world_ = world_.to_world(sample);
  machine_.set_position(now_ns, *p_world_);
}

bool LandingMission::looks_at_dense() const {
  return machine_.state() == MissionState::kConfirm || machine_.state() == MissionState::kFinalDescent;
}

void LandingMission::tell(std::int64_t now_ns, const FrameReport& frame) {
  FrameEvidence evidence;
  evidence.age_s = to_seconds(now_ns - frame.depth.t_ns);
  evidence.dense_lidar =
      frame.depth.source == DepthSource::kFallback && frame.depth.accumulation_s >= full_window_s_;
  if (frame.decision.site && frame.decision.site->accepted)
    evidence.accepted = place_of(*frame.decision.site);
  if (frame.selection && frame.depth.T_world_camera) {
    if (frame.selection->largest) {
      evidence.largest = place_of(*frame.selection->largest, *frame.selection, *frame.depth.T_world_camera);
    }
    if (const auto rule = machine_.check_rule()) {
      evidence.check = check_site(selector_, *frame.selection, *frame.depth.T_world_camera,
                                  machine_.target()->place.p_world, *rule);
    }
  }
  machine_.add(now_ns, evidence);
}

std::vector<FrameReport> LandingMission::add(std::int64_t now_ns, const LogMessage& message) {
  if (const auto* position = std::get_if<PositionSample>(&message)) locate(now_ns, *position);
  std::vector<FrameReport> frames = pipeline_.add(message);
  const bool dense_alone = dense_ && looks_at_dense();
  if (!dense_alone) {
    for (const FrameReport& frame : frames) tell(now_ns, frame);
  }
  // Without images every packet makes a frame of dense LiDAR.
  if (dense_ && !std::holds_alternative<StereoFrame>(message)) {
    const std::vector<FrameReport> dense = dense_->add(message);
    for (const FrameReport& frame : dense) {
      if (dense_alone) tell(now_ns, frame);
    }
  }
  return frames;
}

MissionCommand LandingMission::step(std::int64_t now_ns) {
  if (to_seconds(now_ns - health_ns_) >= kHealthPeriod_s) {
    health_ns_ = now_ns;
    health_ = pipeline_.health(now_ns);
    machine_.set_health(health_);
  }
  return machine_.step(now_ns);
}

}  // namespace alight
