#include "infer/landing_pipeline.hpp"

#include <utility>

namespace alight {

void bind(Binder& b, LandingConfig& c) {
  b.section("selection", c.selection, "what safe ground is");
  b.section("tracker", c.tracker, "when a site counts");
}

std::string FrameReport::site_reason() const {
  const bool failed = health.state == HealthState::kFailed;
  if (failed && !depth.depth_m.empty()) return "sensors failed: " + describe(health);
  if (!selection) return "no trusted depth: " + depth.reason;
  if (decision.site && !selection->found()) return "previous site kept";
  return describe(*selection);
}

ImageSite in_camera_image(const LandingSite& site, const Eigen::Matrix3d& R_level_camera,
                          const PinholeIntrinsics& intrinsics) {
  const Eigen::Vector3d p_camera = R_level_camera.transpose() * site.p_level;
  const Eigen::Vector2d pixel = intrinsics.project(p_camera);
  return {pixel.x(), pixel.y(), site.radius_m * intrinsics.fx_px / p_camera.z()};
}

LandingPipeline::LandingPipeline(const DepthEngineConfig& engine, const LandingConfig& landing,
                                 const Rig& rig, std::shared_ptr<DepthPredictor> predictor)
    : monitor_(engine.health, rig, predictor != nullptr ? DepthMakers::kImageAndLidar : DepthMakers::kLidar),
      engine_(engine, rig, std::move(predictor)),
      selector_(landing.selection, engine_.rig().intrinsics),
      tracker_(landing.tracker, selector_) {}

std::vector<FrameReport> LandingPipeline::add(const LogMessage& message) {
  const std::vector<LogMessage> believed = monitor_.add(message);
  if (monitor_.take_lidar_spoiled()) engine_.forget_lidar("the LiDAR points so far do not hold any more");
  health_ = monitor_.report();
  pass_on(believed);
  return report();
}

void LandingPipeline::pass_on(const std::vector<LogMessage>& messages) {
  for (const LogMessage& message : messages) {
    engine_.add(message);
    const auto* packet = std::get_if<LidarPacket>(&message);
    if (packet != nullptr && monitor_.camera_lost()) engine_.add(StereoFrame{end_of(*packet), {}, {}});
  }
}

std::vector<FrameReport> LandingPipeline::finish() {
  pass_on(monitor_.finish());
  engine_.finish();
  return report();
}

std::vector<FrameReport> LandingPipeline::report() {
  std::vector<FrameReport> reports;
  for (DepthResult& depth : engine_.take_results()) reports.push_back(report(std::move(depth)));
  return reports;
}

FrameReport LandingPipeline::report(DepthResult depth) {
  FrameReport frame;
  frame.depth = std::move(depth);
  frame.health = health_;
  // An image out of time order has no place in a row of consecutive frames.
  if (last_ns_ && frame.depth.t_ns <= *last_ns_) return frame;
  last_ns_ = frame.depth.t_ns;
  if (frame.depth.depth_m.empty() || health_.state == HealthState::kFailed) {
    frame.decision = tracker_.update_without_depth(frame.depth.t_ns);
    return frame;
  }
  const StageTimer timer(frame.depth.stages_ms, "site");
  const Eigen::Isometry3d& T_world_camera = *frame.depth.T_world_camera;
  frame.selection = selector_.select(frame.depth.depth_m, T_world_camera);
  frame.decision = tracker_.update(frame.depth.t_ns, *frame.selection, T_world_camera);
  if (frame.decision.site) {
    frame.image_site = in_camera_image(frame.decision.site->circle, frame.selection->R_level_camera,
                                       engine_.rig().intrinsics);
  }
  return frame;
}

}  // namespace alight
