#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "foundation/binder_fwd.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/sensor_config.hpp"
#include "sim/truth/surface_truth.hpp"
#include "sim/vehicle/flight_plan.hpp"
#include "sim/world/world.hpp"

namespace alight::sim {

/// One flight to record.
struct FlightConfig {
  std::string name = "flight";
  std::int64_t seed = 1;  ///< of the path's turns and of all noise
  WorldConfig world;
  FlightPlanConfig plan;
};
void bind(Binder& b, FlightConfig& c);

enum class BagCompression { kNone, kLz4 };

/// How flights are written.
struct RecorderConfig {
  BagCompression compression = BagCompression::kNone;
  bool truth = true;  ///< depth and safe ground of every left image
  int truth_png_level = 1;
  double trajectory_rate_hz = 200;
  double clearance_m = 2.0;    ///< a path nearer to an obstacle is refused
  double edge_margin_m = 5.0;  ///< and one nearer to the edge of its world
  int threads = 2;
};
void bind(Binder& b, RecorderConfig& c);

/// All of alight-sim's configuration file.
struct SimConfig {
  std::string rig = "configs/rigs/paper.yaml";
  SensorsConfig sensors;
  RendererConfig renderer;
  SurfaceTruthConfig surface_truth;
  RecorderConfig recorder;
  std::vector<FlightConfig> flights = {FlightConfig()};
};
void bind(Binder& b, SimConfig& c);

}  // namespace alight::sim
