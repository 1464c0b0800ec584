#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <opencv2/core.hpp>

#include "geometry/rig/rig.hpp"
#include "sim/record/sim_config.hpp"
#include "sim/record/simulated_flight.hpp"

namespace alight::sim {

/// What is true of a simulated flight, in the folder `<flight>.truth`:
///   depth/<t_ns>.png  16 bit, 1/256 m, plane depth of the left camera, 0 = sky; t_ns: the image's stamp in the bag
///   safe/<t_ns>.png   8 bit, 255 = safe ground
///   trajectory.csv    T_world_imu; t_ns on the clock of attitude and position in the bag; world: East-North-Up with
///                     its origin at the true position at the first fix, which is what a reader of the bag builds
///   rig.yaml          the rig with the clocks' true time shifts
///   truth.yaml        all settings
class TruthWriter {
 public:
  /// `folder` must exist. @throws DataError
  explicit TruthWriter(const std::filesystem::path& folder, int png_level = 1);

  /// May be called from several threads. @param depth_m CV_32FC1, @param safe CV_8UC1. @throws DataError
  void write_frame(std::int64_t stamp_ns, const cv::Mat& depth_m, const cv::Mat& safe) const;
  /// Poses at a fixed rate from the first to the last moment.
  void write_trajectory(const SimulatedFlight& flight, double rate_hz, std::int64_t start_ns) const;
  void write_description(const SimConfig& config, const FlightConfig& flight, const Rig& rig,
                         std::int64_t frames) const;

 private:
  std::filesystem::path folder_;
  int png_level_;
};

}  // namespace alight::sim
