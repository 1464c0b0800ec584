#pragma once

#include "foundation/binder_fwd.hpp"

namespace alight {

/// What is done with points that the LiDAR itself takes for noise: rain, dust, and echoes dragged between two surfaces. A
/// vehicle that lands must not take them for obstacles in the air, nor for ground that is nearer than it is.
enum class NoisePoints {
  kKeep,         ///< they are points like others
  kDropCertain,  ///< what the sensor is sure of goes
  kDropLikely,   ///< and what it finds likely, the default: one lost point of ground matters less
};

/// The rig's key for it.
void bind_noise_points(Binder& b, const char* key, NoisePoints& noise);

}  // namespace alight
