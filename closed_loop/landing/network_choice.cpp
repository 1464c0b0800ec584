#include "closed_loop/landing/network_choice.hpp"

#include "foundation/errors.hpp"
#include "foundation/shipped_files.hpp"
#ifdef ALIGHT_SIM_WITH_NETWORK
#include "infer/network/chosen_predictor.hpp"
#endif

namespace alight::closed_loop {

std::shared_ptr<DepthPredictor> choose_network(const LandConfig& config, bool lidar_only) {
  if (lidar_only || !config.flight.images) return nullptr;
#ifdef ALIGHT_SIM_WITH_NETWORK
  ReplayConfig replay;
  replay.checkpoint = config.checkpoint;
  replay.network = config.network;
  replay.engine = config.engine;
  return make_chosen_predictor(replay, load_rig(input_file(config.rig)), false);
#else
  throw ConfigError("this alight-sim was built without LibTorch and has no network; land with --lidar-only");
#endif
}

}  // namespace alight::closed_loop
