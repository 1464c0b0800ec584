#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "foundation/binder_fwd.hpp"
#include "infer/depth/depth_engine.hpp"
#include "infer/health/health_monitor.hpp"
#include "infer/landing/memory/fused_selection.hpp"
#include "infer/landing/memory/site_tracker.hpp"
#include "infer/landing/site_selector.hpp"

namespace alight {

/// Which decision the tracker follows. Both are made and logged unless the grid is off.
enum class SiteSource {
  kFrame,  ///< what this frame's depth says (the paper)
  // Of plane_fit alone: the memory is judged by planes.
  kFused,  ///< what all frames together know of the ground
  kBoth,   ///< this frame's depth, less where an earlier one saw something rise or fall
};

/// What makes a landing site. Files: configs/landing/*.yaml
struct LandingConfig {
  SiteSelectionConfig selection;
  /// Keep the elevation grid; needed for site_source fused and both. Beside the derivatives, planes with their defaults
  /// judge it for the log.
  bool fuse = true;
  SiteSource site_source = SiteSource::kBoth;
  ElevationGridConfig grid;
  SiteTrackerConfig tracker;
};
void bind(Binder& b, LandingConfig& c);

/// A site as the real left image shows it (rectified and cropped).
struct ImageSite {
  double u_px = 0;
  double v_px = 0;
  double radius_px = 0;  ///< as seen at the centre's depth
};

/// Everything known about one left image.
struct FrameReport {
  DepthResult depth;
  std::optional<SiteSelection> selection;  ///< of this frame's depth; absent without trusted depth
  std::optional<SiteSelection> fused;      ///< of the elevation grid; absent as above, or if it is not kept
  SiteDecision decision;
  std::optional<ImageSite> image_site;  ///< decision.site in the image
  HealthReport health;

  /// The selection that `decision` follows.
  const SiteSelection& decisive() const { return from_fused ? *fused : *selection; }
  bool from_fused = false;
  /// Why there is no site, or what the site is.
  std::string site_reason() const;
};

/// The depth of an image, and how the sensors were when it became final.
struct SensedDepth {
  DepthResult depth;
  HealthReport health;
};

/// Messages in, depth per left image out. The sensors' health is judged first (HealthMonitor), and only what may be
/// believed goes to the engine. While no usable images come, every LiDAR packet makes a frame of its own, without image, so
/// that landing goes on by the LiDAR alone.
class DepthStage {
 public:
  DepthStage(const DepthEngineConfig& engine, const Rig& rig, std::shared_ptr<DepthPredictor> predictor);

  /// @returns what became final, in image order
  std::vector<SensedDepth> add(const LogMessage& message);
  /// No more messages will come.
  std::vector<SensedDepth> finish();

  const DepthEngine& engine() const { return engine_; }
  /// The sensors' health as of the latest message, whether or not a frame came of it.
  const HealthReport& health() const { return health_; }
  /// The same at a later moment, for whoever has a clock of the sensors' time and waits in vain for a message.
  HealthReport health(std::int64_t now_ns) const { return monitor_.report(now_ns); }

 private:
  void pass_on(const std::vector<LogMessage>& messages);
  std::vector<SensedDepth> take();

  HealthMonitor monitor_;
  HealthReport health_;
  DepthEngine engine_;
};

/// Depth in, landing decision out; knows nothing of the other stage, so that both may work at once.
class SiteStage {
 public:
  SiteStage(const LandingConfig& landing, const PinholeIntrinsics& intrinsics);

  /// In the order in which DepthStage gave them.
  FrameReport report(SensedDepth sensed);

 private:
  PinholeIntrinsics intrinsics_;
  SiteSelector selector_;
  std::optional<FusedSelector> fused_;
  SiteSource site_source_;
  SiteTracker tracker_;
  std::optional<std::int64_t> last_ns_;
};

/// Messages in, depth and landing decision per left image out: both stages, one after the other.
class LandingPipeline {
 public:
  LandingPipeline(const DepthEngineConfig& engine, const LandingConfig& landing, const Rig& rig,
                  std::shared_ptr<DepthPredictor> predictor);

  /// @returns the frames that became final, in image order
  std::vector<FrameReport> add(const LogMessage& message) { return report(depth_.add(message)); }
  /// No more messages will come.
  std::vector<FrameReport> finish() { return report(depth_.finish()); }

  const DepthEngine& engine() const { return depth_.engine(); }
  const HealthReport& health() const { return depth_.health(); }
  HealthReport health(std::int64_t now_ns) const { return depth_.health(now_ns); }

  /// For whoever runs the stages in threads of their own.
  DepthStage& depth() { return depth_; }
  SiteStage& sites() { return sites_; }

 private:
  std::vector<FrameReport> report(std::vector<SensedDepth> sensed);

  DepthStage depth_;
  SiteStage sites_;
};

/// A circle of the level camera's image in the image of the camera itself.
ImageSite in_camera_image(const LandingSite& site, const Eigen::Matrix3d& R_level_camera,
                          const PinholeIntrinsics& intrinsics);

}  // namespace alight
