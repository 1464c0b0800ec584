#pragma once

#include <filesystem>
#include <memory>

#include "infer/onboard/engine_runner.hpp"
#include "infer/recorder/flight_recorder.hpp"
#include "tests/infer/fakes.hpp"

namespace alight::fakes {

constexpr double kRecordedHeight_m = 12;

inline RecordedSettings small_settings() {
  RecordedSettings settings;
  settings.engine.width_px = 160;
  settings.engine.height_px = 144;
  return settings;
}

/// Flies a hover of two seconds over level ground, whose LiDAR falls silent after `lidar_end_s`, by the LiDAR alone, and
/// records it. @returns the recorder's count
inline RecorderStatistics record_flight(const std::filesystem::path& folder, const RecorderConfig& config,
                                        double lidar_end_s) {
  const RecordedSettings settings = small_settings();
  FlightRecorder recorder(config, folder, settings);
  LevelWorld world(kRecordedHeight_m);
  FlightPlan plan;
  plan.lidar_end_s = lidar_end_s;
  plan.duration_s = 2.5;
  MessageQueueConfig roomy;
  roomy.max_images = 1000;
  roomy.max_packets = 1000;
  EngineRunner runner(
      roomy, std::make_unique<LandingPipeline>(settings.engine, settings.landing, small_rig(), nullptr),
      {&recorder});
  for (const LogMessage& message : flight(world, plan)) runner.push(message);
  runner.finish();
  return recorder.statistics();
}

}  // namespace alight::fakes
