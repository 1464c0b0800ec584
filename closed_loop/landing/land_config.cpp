#include "closed_loop/landing/land_config.hpp"

#include "foundation/config_reader.hpp"

namespace alight::closed_loop {

void bind(Binder& b, LandFlightConfig& c) {
  b.field("start_height_m", c.start_height_m, "over the ground where the landing begins", between(5, 150));
  b.field("clear_above_m", c.clear_above_m, "but so much over everything inside the geofence",
          between(0, 100));
  b.field("automatic_after_s", c.automatic_after_s, "when automatic mode is switched on", between(0.1, 60));
  b.field("command_rate_hz", c.command_rate_hz, "set points a second", between(1, 200));
  b.field("latency_s", c.latency_s, "from a message's receipt to the vehicle's reaction", between(0, 5));
  b.field("body_radius_m", c.body_radius_m, "rotors included; a touchdown needs so much safe ground",
          between(0.1, 10));
  b.field("skid_radius_m", c.skid_radius_m, "where the vehicle touches the ground", between(0.05, 10));
  b.field("skid_height_m", c.skid_height_m, "IMU over the ground when landed", between(0.05, 5));
  b.field("battery_s", c.battery_s, "a full charge lasts so long", between(10, 100000));
  b.field("wanted_radius_m", c.wanted_radius_m, "truly safe ground of this radius counts as a site",
          between(0.1, 100));
  b.field("images", c.images, "false: no camera is flown; the LiDAR lands alone");
}

LandConfig::LandConfig() {
  renderer.edge_samples = 1;
  sensors.camera.rate_hz = 10;
}

void bind(Binder& b, LandConfig& c) {
  bind(b, c.landing);
  b.section("mission", c.mission, "how a landing is flown");
  b.section("engine", c.engine, "how messages become depth");
  b.section("network", c.network, "how the network is run");
  b.field("checkpoint", c.checkpoint, "trained network; none: the one that came with the program");
  b.field("rig", c.rig, "rig file, relative to the working directory");
  b.section("world", c.world, "the place");
  b.section("flight", c.flight, "the vehicle's body, beginning and end of a landing");
  b.section("vehicle", c.vehicle, "how the vehicle follows set points, and the wind");
  b.section("sensors", c.sensors, "what the sensors measure and when");
  b.section("renderer", c.renderer, "how images are made");
  b.section("surface_truth", c.surface_truth, "what counts as safe ground");
}

}  // namespace alight::closed_loop
