#include "infer/autopilot/send_rule.hpp"

namespace alight {

const char* reason_to_withhold(const FrameReport& frame, FlightMode mode, double age_s, double max_age_s) {
  if (mode != FlightMode::kAutomatic) return "manual mode";
  if (frame.health.state == HealthState::kFailed) return "sensors failed";
  if (frame.depth.source == DepthSource::kNone) return "no trusted depth";
  if (!frame.decision.site) return "no landing site";
  if (!frame.decision.site->accepted) return "landing site not confirmed";
  if (!frame.depth.T_world_camera) return "no pose";
  if (!frame.depth.T_world_camera->matrix().allFinite() || !frame.decision.site->p_world.allFinite())
    return "position not finite";
  if (!(age_s <= max_age_s)) return "result too old";
  return nullptr;
}

}  // namespace alight
