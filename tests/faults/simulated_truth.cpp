#include "tests/faults/simulated_truth.hpp"

#include <cmath>

#include "geometry/frames.hpp"
#include "sensors/stream/flight_log.hpp"
#include "sim/record/simulated_log.hpp"
#include "sim/truth/flight_score.hpp"

namespace alight {
namespace {

/// Fields, trees and houses from 18 m, 3 m/s forward while turning.
sim::SimConfig flight_config() {
  sim::SimConfig config;
  config.rig = (std::filesystem::path(ALIGHT_SOURCE_DIR) / "configs" / "rigs" / "paper.yaml").string();
  config.sensors.camera.rate_hz = 10;
  config.renderer.edge_samples = 1;
  config.recorder.truth = false;
  sim::FlightConfig& flight = config.flights.front();
  flight.seed = 9;
  flight.world.look = sim::Look::kVillage;
  flight.world.seed = 22;
  flight.world.size_m = 90;
  flight.plan.kind = sim::PlanKind::kStraight;
  flight.plan.start_height_m = 18;
  flight.plan.speed_mps = 3;
  flight.plan.yaw_rate_deg_per_s = 10;
  flight.plan.duration_s = 6;
  return config;
}

}  // namespace

SimulatedTruth::SimulatedTruth(const std::filesystem::path& folder) {
  const sim::SimConfig config = flight_config();
  rig_ = sim::true_rig(load_rig(config.rig), config.sensors);
  const sim::FlightConfig& flight = config.flights.front();
  sim::FlightRecorder(config, folder).record(flight);
  const RectifiedRig rectified = sim::flyable_rig(rig_, config.rig);
  T_camera_imu_ = rectified.T_camera_imu;
  flight_ = std::make_unique<sim::SimulatedFlight>(flight, config, rectified);
  begin_ns_ = config.sensors.start_time_s * kNanosecondsPerSecond;
  FlightLog log(folder / (flight.name + ".bag"), rig_, {});
  for (LogMessage message; log.next(message);) messages_.push_back({log.receive_ns(), message});
}

bool SimulatedTruth::is_safe(const FrameReport& frame) const {
  const TrackedSite& site = *frame.decision.site;
  const double t_s = to_seconds(frame.depth.t_ns - begin_ns_);
  const Eigen::Vector3d p_camera = frame.depth.T_world_camera->inverse() * site.p_world;
  const Eigen::Vector3d p_sim = flight_->vehicle().T_world_imu(t_s) * T_camera_imu_.inverse() * p_camera;
  const sim::SurfaceTruth& truth = flight_->surface_truth();
  if (!truth.is_safe(p_sim.x(), p_sim.y())) return false;
  constexpr double kStep_m = 0.1;
  int inside = 0;
  int safe = 0;
  for (double y_m = -site.circle.radius_m; y_m <= site.circle.radius_m; y_m += kStep_m) {
    for (double x_m = -site.circle.radius_m; x_m <= site.circle.radius_m; x_m += kStep_m) {
      if (std::hypot(x_m, y_m) > site.circle.radius_m) continue;
      ++inside;
      safe += truth.is_safe(p_sim.x() + x_m, p_sim.y() + y_m) ? 1 : 0;
    }
  }
  return safe >= sim::kSafeCircleShare * inside;
}

}  // namespace alight
