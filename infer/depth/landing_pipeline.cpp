#include "infer/depth/landing_pipeline.hpp"

#include <utility>

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, LandingConfig& c) {
  b.section("selection", c.selection, "what safe ground is");
  b.field("fuse", c.fuse, "remember the ground over frames in an elevation grid");
  b.choice(
      "site_source", c.site_source,
      {{"frame", SiteSource::kFrame}, {"fused", SiteSource::kFused}, {"both", SiteSource::kBoth}},
      "frame: this frame's depth decides; fused: the remembered ground; both: the frame, less remembered "
      "obstacles");
  b.check("site_source", c.fuse || c.site_source == SiteSource::kFrame,
          "fused and both need fuse: true; say site_source: frame");
  b.check("site_source",
          c.site_source == SiteSource::kFrame || c.selection.method == LandingMethod::kPlaneFit,
          "fused and both need selection.method: plane_fit; say site_source: frame");
  b.section("grid", c.grid, "what is remembered of the ground");
  b.section("tracker", c.tracker, "when a site counts");
}

std::string FrameReport::site_reason() const {
  const bool failed = health.state == HealthState::kFailed;
  if (failed && !depth.depth_m.empty()) return "sensors failed: " + describe(health);
  if (!selection) return "no trusted depth: " + depth.reason;
  if (decision.site && !decisive().found()) return "previous site kept";
  return describe(decisive());
}

ImageSite in_camera_image(const LandingSite& site, const Eigen::Matrix3d& R_level_camera,
                          const PinholeIntrinsics& intrinsics) {
  const Eigen::Vector3d p_camera = R_level_camera.transpose() * site.p_level;
  const Eigen::Vector2d pixel = intrinsics.project(p_camera);
  return {pixel.x(), pixel.y(), site.radius_m * intrinsics.fx_px / p_camera.z()};
}

DepthStage::DepthStage(const DepthEngineConfig& engine, const Rig& rig,
                       std::shared_ptr<DepthPredictor> predictor)
    : monitor_(engine.health, rig, predictor != nullptr ? DepthMakers::kImageAndLidar : DepthMakers::kLidar),
      engine_(engine, rig, std::move(predictor)) {}

std::vector<SensedDepth> DepthStage::add(const LogMessage& message) {
  const std::vector<LogMessage> believed = monitor_.add(message);
  if (monitor_.take_lidar_spoiled()) engine_.forget_lidar("the LiDAR points so far do not hold any more");
  health_ = monitor_.report();
  pass_on(believed);
  return take();
}

void DepthStage::pass_on(const std::vector<LogMessage>& messages) {
  for (const LogMessage& message : messages) {
    engine_.add(message);
    const auto* packet = std::get_if<LidarPacket>(&message);
    if (packet != nullptr && monitor_.camera_lost()) engine_.add(StereoFrame{end_of(*packet), {}, {}});
  }
}

std::vector<SensedDepth> DepthStage::finish() {
  pass_on(monitor_.finish());
  engine_.finish();
  return take();
}

std::vector<SensedDepth> DepthStage::take() {
  std::vector<SensedDepth> sensed;
  for (DepthResult& depth : engine_.take_results()) sensed.push_back({std::move(depth), health_});
  return sensed;
}

SiteStage::SiteStage(const LandingConfig& landing, const PinholeIntrinsics& intrinsics)
    : intrinsics_(intrinsics),
      selector_(landing.selection, intrinsics),
      fused_(landing.fuse ? std::optional<FusedSelector>(
                                std::in_place, landing.grid,
                                PlaneJudge(landing.selection.plane_fit, landing.selection.rules, intrinsics))
                          : std::nullopt),
      site_source_(landing.site_source),
      tracker_(landing.tracker, landing.selection.rules.min_radius_m, intrinsics) {}

FrameReport SiteStage::report(SensedDepth sensed) {
  FrameReport frame;
  frame.depth = std::move(sensed.depth);
  frame.health = std::move(sensed.health);
  // An image out of time order has no place in a row of consecutive frames.
  if (last_ns_ && frame.depth.t_ns <= *last_ns_) return frame;
  last_ns_ = frame.depth.t_ns;
  if (frame.depth.depth_m.empty() || frame.health.state == HealthState::kFailed) {
    frame.decision = tracker_.update_without_depth(frame.depth.t_ns);
    return frame;
  }
  const StageTimer timer(frame.depth.stages_ms, "site");
  const Eigen::Isometry3d& T_world_camera = *frame.depth.T_world_camera;
  SiteSelection seen = selector_.look(frame.depth.depth_m, T_world_camera);
  cv::Mat remembered;
  if (fused_) {
    // What a network alone shows is hazard enough in its own frame; where the memory decides alone, it has to keep it.
    const bool vouched = frame.depth.source != DepthSource::kFallback && site_source_ != SiteSource::kFused;
    frame.fused = fused_->update(frame.depth.t_ns, frame.depth.depth_m, frame.depth.sparse_m, T_world_camera,
                                 seen, vouched);
    frame.from_fused = site_source_ == SiteSource::kFused;
    if (site_source_ == SiteSource::kBoth) remembered = fused_->grid().obstacles(seen.ground.raster);
  }
  frame.selection = selector_.decide(std::move(seen), remembered, T_world_camera);
  frame.decision = tracker_.update(frame.depth.t_ns, frame.decisive(), T_world_camera);
  if (frame.decision.site) {
    frame.image_site =
        in_camera_image(frame.decision.site->circle, frame.selection->R_level_camera, intrinsics_);
  }
  return frame;
}

LandingPipeline::LandingPipeline(const DepthEngineConfig& engine, const LandingConfig& landing,
                                 const Rig& rig, std::shared_ptr<DepthPredictor> predictor)
    : depth_(engine, rig, std::move(predictor)), sites_(landing, depth_.engine().rig().intrinsics) {}

std::vector<FrameReport> LandingPipeline::report(std::vector<SensedDepth> sensed) {
  std::vector<FrameReport> reports;
  for (SensedDepth& one : sensed) reports.push_back(sites_.report(std::move(one)));
  return reports;
}

}  // namespace alight
