#include "infer/network/chosen_predictor.hpp"

#include <optional>

#include <spdlog/spdlog.h>

#include "foundation/errors.hpp"
#include "foundation/shipped_files.hpp"
#include "infer/network/network_predictor.hpp"

namespace alight {

namespace {

/// With one camera there is no right image to reconstruct.
void say_what_mono_means(const DepthEngineConfig& config) {
  spdlog::info("mono rig: predictions are judged by held-out LiDAR points, not by stereo");
  if (config.image.self_evaluation.decide_by == DecideBy::kStereo) {
    spdlog::warn(
        "engine.image.self_evaluation.decide_by is stereo, which never accepts with a mono rig; set it to "
        "lidar_holdout");
  }
}

}  // namespace

std::filesystem::path chosen_network(const ReplayConfig& config) {
  std::optional<std::filesystem::path> checkpoint;
  if (config.checkpoint) checkpoint = input_file(*config.checkpoint);
  if (!checkpoint && (checkpoint = shipped_file("models/weights/default.pt"))) {
    spdlog::info("network: {} (no checkpoint was named)", checkpoint->string());
  }
  if (!checkpoint) {
    throw ConfigError(
        "no network: none came with this program; name one as checkpoint, or ask for LiDAR only");
  }
  return *checkpoint;
}

std::shared_ptr<DepthPredictor> make_chosen_predictor(const ReplayConfig& config, const Rig& rig,
                                                      bool lidar_only) {
  if (lidar_only) return nullptr;
  if (!rig.cam1) say_what_mono_means(config.engine);
  return make_network_predictor(chosen_network(config), engine_rig(config.engine, rig), config.network);
}

}  // namespace alight
