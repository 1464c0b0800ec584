#include "infer/chosen_predictor.hpp"

#include <optional>

#include <spdlog/spdlog.h>

#include "configs/errors.hpp"
#include "infer/network_predictor.hpp"
#include "infer/shipped_model.hpp"

namespace alight {

std::filesystem::path chosen_network(const ReplayConfig& config) {
  std::optional<std::filesystem::path> checkpoint;
  if (config.checkpoint) checkpoint = *config.checkpoint;
  if (!checkpoint && (checkpoint = find_shipped_model(this_executable()))) {
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
  return make_network_predictor(chosen_network(config), engine_rig(config.engine, rig), config.network);
}

}  // namespace alight
