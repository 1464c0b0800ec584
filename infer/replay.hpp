#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "configs/config_reader.hpp"
#include "dataset/flight_log.hpp"
#include "infer/landing_pipeline.hpp"
#include "infer/network_config.hpp"
#include "infer/result_writer.hpp"

namespace alight {

/// A flight log replayed through the onboard loop. Files: configs/infer/*.yaml
struct ReplayConfig {
  std::string rig = "configs/rigs/paper.yaml";
  std::optional<std::string> checkpoint;  ///< none: the one that came with the program
  NetworkConfig network;
  int overlay_every = 20;     ///< a picture every so many images; 0: none
  bool write_timings = true;  ///< stages_ms in results.jsonl; without, runs are equal byte for byte
  LogConfig log;
  DepthEngineConfig engine;
  LandingConfig landing;
};
void bind(Binder& b, ReplayConfig& c);

/// Replays a ROS 1 bag in the order in which it was recorded and writes results.jsonl, overlay/<t_ns>.png and method.png
/// (the first accepted site that a prediction found; else the first accepted one) to `output`, a folder that must not
/// exist. An empty `output` writes nothing.
/// @throws DataError (log, output), ConfigError (rig)
ReplaySummary replay(const ReplayConfig& config, const Rig& rig, const std::filesystem::path& log,
                     const std::filesystem::path& output, std::shared_ptr<DepthPredictor> predictor);

/// The rig of the images that the engine will show to a predictor.
RectifiedRig engine_rig(const DepthEngineConfig& config, const Rig& rig);

}  // namespace alight
