#pragma once

#include <optional>
#include <string>

#include "foundation/binder_fwd.hpp"
#include "infer/depth/landing_pipeline.hpp"
#include "infer/mission/mission_config.hpp"
#include "infer/replay/network_config.hpp"
#include "sim/render/renderer.hpp"
#include "sim/sensors/sensor_config.hpp"
#include "sim/truth/surface_truth.hpp"
#include "sim/vehicle/multirotor.hpp"
#include "sim/world/world.hpp"

namespace alight::closed_loop {

/// The body of the vehicle, and how a landing begins and ends.
struct LandFlightConfig {
  /// Of the beginning over the ground there; raised where something inside the geofence would come closer than
  /// clear_above_m below.
  double start_height_m = 28;
  double clear_above_m = 6;
  double automatic_after_s = 1.0;
  double command_rate_hz = 20;
  double latency_s =
      0.1;  ///< from a message's receipt to the vehicle's reaction: what computing takes in flight
  double body_radius_m = 0.85;  ///< rotors included; the safe ground that a touchdown needs
  double skid_radius_m = 0.4;
  double skid_height_m = 0.3;  ///< IMU over the ground when landed
  double battery_s = 420;      ///< a full charge lasts so long
  double wanted_radius_m =
      3;               ///< "there was a safe site": truly safe ground of this radius inside the geofence
  bool images = true;  ///< false: no camera is flown; the LiDAR lands alone
};
void bind(Binder& b, LandFlightConfig& c);

/// Everything about a simulated landing. A file of configs/landing/ is one, with the defaults for the rest.
struct LandConfig {
  LandingConfig landing;  ///< its sections stand at the top
  MissionConfig mission;
  DepthEngineConfig engine;
  NetworkConfig network;
  std::optional<std::string> checkpoint;  ///< none: the one that came with the program
  std::string rig = "configs/rigs/paper.yaml";
  sim::WorldConfig world;
  LandFlightConfig flight;
  sim::MultirotorConfig vehicle;
  sim::SensorsConfig sensors;
  sim::RendererConfig renderer;
  sim::SurfaceTruthConfig surface_truth;

  LandConfig();
};
void bind(Binder& b, LandConfig& c);

}  // namespace alight::closed_loop
