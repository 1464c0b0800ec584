#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "foundation/binder_fwd.hpp"
#include "infer/autopilot/autopilot_config.hpp"
#include "infer/depth/landing_pipeline.hpp"
#include "infer/onboard/engine_runner.hpp"
#include "infer/replay/network_config.hpp"
#include "infer/replay/result_writer.hpp"
#include "sensors/stream/flight_log.hpp"

namespace alight {

/// A flight log replayed through the onboard loop. Files: configs/infer/*.yaml
struct ReplayConfig {
  std::string rig = "configs/rigs/paper.yaml";
  std::optional<std::string> checkpoint;  ///< none: the one that came with the program
  NetworkConfig network;
  int overlay_every = 20;     ///< a picture every so many images; 0: none
  int depth_every = 0;        ///< a depth map every so many images; 0: none
  bool write_timings = true;  ///< stages_ms in results.jsonl; without, runs are equal byte for byte
  LogConfig log;
  MessageQueueConfig queue;
  DepthEngineConfig engine;
  LandingConfig landing;
  AutopilotConfig autopilot;
};
void bind(Binder& b, ReplayConfig& c);

/// The results of a replay as files: results.jsonl, overlay/<t_ns>.png, depth/<t_ns>.tiff and method.png (the first accepted site that a
/// prediction found; else the first accepted one) in a folder that appears when commit() is called; and their summary.
class ReplayResults : public FrameSink {
 public:
  /// @param output must not exist; empty: no files. @throws DataError if it cannot be made
  ReplayResults(const ReplayConfig& config, const std::filesystem::path& output, const cv::Rect& crop);
  ~ReplayResults() override;

  /// @throws DataError if a file cannot be written
  void on_frame(const FrameReport& frame) override;
  void commit();
  /// Not while frames come in on another thread.
  ReplaySummary& summary() { return summary_; }

 private:
  class Files;
  std::unique_ptr<Files> files_;
  ReplaySummary summary_;
};

/// How a log is replayed.
struct ReplayPace {
  bool realtime =
      false;       ///< messages come when they came in flight, and the engine loses what it is too slow for
  int rounds = 1;  ///< the log over and over
};

/// Replays a ROS 1 bag in the order in which it was recorded; results go to `results`, then to the other sinks.
/// @param observe called with the runner before the first message, and with null before it goes; realtime only
/// @returns the summary, `results` committed. @throws DataError (log, output), ConfigError (rig)
ReplaySummary replay(const ReplayConfig& config, const Rig& rig, const std::filesystem::path& log,
                     const std::filesystem::path& output, std::shared_ptr<DepthPredictor> predictor,
                     const ReplayPace& pace = {}, const std::vector<FrameSink*>& sinks = {},
                     const std::function<void(const EngineRunner*)>& observe = {});

/// The rig of the images that the engine will show to a predictor.
RectifiedRig engine_rig(const DepthEngineConfig& config, const Rig& rig);

}  // namespace alight
