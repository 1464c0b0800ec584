#pragma once

#include <cstdint>
#include <filesystem>

#include "geometry/rig/rig.hpp"
#include "sim/record/sim_config.hpp"

namespace alight::sim {

/// What a recorded flight holds.
struct RecordedFlight {
  std::int64_t frames = 0;
  std::int64_t lidar_packets = 0;
  std::int64_t messages = 0;
  std::uintmax_t bag_bytes = 0;
};

/// Flies the flights of a configuration and writes each as `<name>.bag` with its truth in `<name>.truth/`.
/// Both appear whole or not at all. The bytes depend on the configuration alone, not on threads or time.
class FlightRecorder {
 public:
  /// @throws ConfigError for a rig that cannot be flown
  FlightRecorder(const SimConfig& config, const std::filesystem::path& output);

  /// @throws DataError if the output holds any of the configured flights already
  void refuse_existing() const;
  /// @throws ConfigError if the flight's path cannot be flown, DataError if its files cannot be written
  RecordedFlight record(const FlightConfig& flight) const;

 private:
  SimConfig config_;
  std::filesystem::path output_;
  Rig rig_;
};

}  // namespace alight::sim
