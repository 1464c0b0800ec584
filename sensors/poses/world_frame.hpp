#pragma once

#include <memory>

#include "geometry/geodesy.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// The frame `world` of a flight: East-North-Up at the first satellite fix, or, where positions are metres already, the
/// frame they are given in. Copies share the origin.
class WorldFrame {
 public:
  Eigen::Vector3d to_world(const PositionSample& sample);

 private:
  std::shared_ptr<const LocalEnu> enu_;
};

}  // namespace alight
