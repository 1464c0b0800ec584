#pragma once

#include <cstdint>
#include <vector>

#include "sim/sensors/sensor_config.hpp"

namespace alight::sim {

enum class SensorStream { kAttitude, kImu, kPosition, kHeight, kLidar, kCamera };

/// One measurement and when the recording computer receives it. Times from the start of the flight, true
/// clock.
struct ScheduledMessage {
  std::int64_t receive_ns = 0;
  std::int64_t measured_ns = 0;  ///< of a LiDAR message: its first shot
  SensorStream stream = SensorStream::kAttitude;
  std::int64_t index = 0;  ///< number within its stream
};

/// Everything that is measured in a flight, in the order of receipt. Poses are measured up to the end
/// of the flight or just past it, so that every image and shot has one on either side.
std::vector<ScheduledMessage> message_schedule(const SensorsConfig& config, double duration_s);

}  // namespace alight::sim
