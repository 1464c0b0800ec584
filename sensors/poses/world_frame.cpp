#include "sensors/poses/world_frame.hpp"

namespace alight {

Eigen::Vector3d WorldFrame::to_world(const PositionSample& sample) {
  if (const auto* p_world = std::get_if<Eigen::Vector3d>(&sample.position)) return *p_world;
  const auto& fix = std::get<GeodeticPosition>(sample.position);
  if (!enu_) enu_ = std::make_shared<LocalEnu>(fix.latitude_deg, fix.longitude_deg, fix.altitude_m);
  return enu_->to_world(fix.latitude_deg, fix.longitude_deg, fix.altitude_m);
}

}  // namespace alight
