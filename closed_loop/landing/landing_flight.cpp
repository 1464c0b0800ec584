#include "closed_loop/landing/landing_flight.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <deque>
#include <map>

#include "closed_loop/landing/message_feed.hpp"
#include "closed_loop/landing/vehicle_contact.hpp"
#include "foundation/shipped_files.hpp"
#include "geometry/frames.hpp"
#include "infer/mission/landing_mission.hpp"
#include "sim/record/simulated_flight.hpp"

namespace alight::closed_loop {
namespace {

constexpr double kTrackPeriod_s = 0.1;
constexpr double kAfterGivingUp_s = 1.0;
constexpr double kEnoughAfterCritical_s = 90;  // of the longest flight: the way up and a last descent

/// What this process has used of all cores.
double processor_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double landing_start_yaw(std::int64_t seed) {
  return sim::CounterRandom(static_cast<std::uint64_t>(seed), sim::RandomStream::kLandingStart)
      .uniform(0, -kPi, kPi);
}

}  // namespace

class LandingFlight::Impl {
 public:
  Impl(const LandConfig& config, std::int64_t seed, std::shared_ptr<DepthPredictor> predictor,
       const PlannedFault& fault);

  FlownLanding fly(sim::BagWriter* bag);
  const sim::SurfaceTruth& surface_truth() const { return end_truth_ ? *end_truth_ : truth_; }

 private:
  Eigen::Vector3d start() const;
  std::vector<sim::RecordedMessage> measure(const sim::ScheduledMessage& message);
  void send(const sim::RecordedMessage& message);
  void deliver_until(std::int64_t t_ns);
  void command_until(std::int64_t t_ns);
  void fly_to(double t_s);
  void touch();
  void look_for_collisions();
  void count(const std::vector<FrameReport>& frames);
  void note_end(std::int64_t t_ns);
  bool over() const { return ended_; }
  std::int64_t true_ns(std::int64_t clock_ns) const { return clock_ns - start_ns_; }
  LandingResult result() const;

  double begun_s_ = processor_s();
  LandConfig config_;
  std::int64_t seed_;
  Rig rig_;
  RectifiedRig rectified_;
  sim::World world_;
  sim::Renderer renderer_;
  sim::SurfaceTruth truth_;                     // at the start of the flight
  std::optional<sim::SurfaceTruth> end_truth_;  // where things move: at its end
  sim::SensorsConfig sensors_;
  double longest_s_;
  std::int64_t start_ns_;
  sim::Multirotor vehicle_;
  sim::StereoCamera camera_;
  sim::LidarSensor lidar_;
  sim::PoseSensors pose_;
  sim::MessageMaker maker_;
  MessageFeed feed_;
  LandingMission mission_;
  bool lidar_only_;
  PlannedFault fault_;
  sim::FaultFilter filter_;

  std::multimap<std::int64_t, LogMessage> arriving_;               // by receive time
  std::deque<std::pair<double, sim::VelocitySetPoint>> commands_;  // by the time at which they take hold
  std::int64_t next_command_ns_;
  MissionCommand command_;
  std::vector<TrackPoint> track_;
  std::vector<Eigen::Vector3d> ring_;  // where the body's rim was
  double automatic_s_ = 0;
  double end_s_ = 0;
  bool ended_ = false;
  Outcome outcome_ = Outcome::kGaveUp;
  std::string reason_;
  double accumulation_s_ = 0;
  int frames_ = 0;
  int frames_with_depth_ = 0;
};

LandingFlight::Impl::Impl(const LandConfig& config, std::int64_t seed,
                          std::shared_ptr<DepthPredictor> predictor, const PlannedFault& fault)
    : config_(config),
      seed_(seed),
      rig_(sim::true_rig(load_rig(input_file(config.rig)), config.sensors)),
      rectified_(sim::flyable_rig(rig_, config.rig)),
      world_(config.world),
      renderer_(world_, config.renderer),
      truth_(renderer_, config.surface_truth),
      sensors_(sim::effective(config.sensors)),
      longest_s_(config.flight.automatic_after_s + config.mission.time_critical_s + kEnoughAfterCritical_s),
      start_ns_(config.sensors.start_time_s * kNanosecondsPerSecond),
      vehicle_(config.vehicle, start(), landing_start_yaw(seed), static_cast<std::uint64_t>(seed),
               longest_s_),
      camera_(renderer_, vehicle_, rectified_, sensors_.camera, static_cast<std::uint64_t>(seed)),
      lidar_(renderer_, vehicle_, rectified_.T_camera_imu.inverse() * rectified_.T_camera_lidar,
             sensors_.lidar, static_cast<std::uint64_t>(seed)),
      pose_(vehicle_, sensors_, static_cast<std::uint64_t>(seed), world_.ground_height_m(0, 0)),
      maker_(sensors_, rig_),
      feed_(rig_, LogConfig{}),
      mission_(config.mission, config.engine, config.landing, rig_, predictor),
      lidar_only_(predictor == nullptr),
      fault_(fault),
      next_command_ns_(start_ns_) {
  if (fault_.fault == nullptr) return;
  filter_ = fault_.fault->begin(start_ns_ + to_nanoseconds(fault_.at_s));
  if (fault_.lasts_s)
    filter_ = sim::passing(std::move(filter_), start_ns_ + to_nanoseconds(fault_.at_s + *fault_.lasts_s));
}

/// Over the middle of the world, high enough over everything that the search may come to.
Eigen::Vector3d LandingFlight::Impl::start() const {
  const double ground_m = world_.ground_height_m(0, 0);
  const double highest = highest_m(truth_, {0, 0}, config_.mission.geofence_radius_m);
  return {0, 0, std::max(ground_m + config_.flight.start_height_m, highest + config_.flight.clear_above_m)};
}

std::vector<sim::RecordedMessage> LandingFlight::Impl::measure(const sim::ScheduledMessage& message) {
  switch (message.stream) {
    case sim::SensorStream::kCamera: {
      auto [left, right] = maker_.images(camera_.expose_frame(message.index, false), message);
      return {std::move(left), std::move(right)};
    }
    case sim::SensorStream::kLidar:
      return {maker_.lidar(lidar_, message)};
    default:
      return {maker_.pose(pose_, message)};
  }
}

/// A fault sits between the sensor and the onboard computer.
void LandingFlight::Impl::send(const sim::RecordedMessage& message) {
  for (LogMessage& complete : feed_.add(message)) {
    sim::TimedMessage timed{message.receive_ns, std::move(complete)};
    if (filter_ && !filter_(timed)) continue;
    arriving_.emplace(timed.receive_ns, std::move(timed.message));
  }
}

void LandingFlight::Impl::count(const std::vector<FrameReport>& frames) {
  for (const FrameReport& frame : frames) {
    ++frames_;
    if (frame.depth.source == DepthSource::kNone) continue;
    ++frames_with_depth_;
    accumulation_s_ += frame.depth.accumulation_s;
  }
}

void LandingFlight::Impl::deliver_until(std::int64_t t_ns) {
  while (!arriving_.empty() && arriving_.begin()->first <= t_ns && !over()) {
    const auto first = arriving_.begin();
    command_until(first->first);
    count(mission_.add(first->first, first->second));
    arriving_.erase(first);
  }
  command_until(t_ns);
}

void LandingFlight::Impl::command_until(std::int64_t t_ns) {
  while (next_command_ns_ <= t_ns && !over()) {
    const double t_s = to_seconds(true_ns(next_command_ns_));
    const bool automatic = t_s >= config_.flight.automatic_after_s;
    if (automatic && automatic_s_ <= 0) automatic_s_ = t_s;
    fly_to(t_s);
    mission_.machine().set_manual(!automatic);
    mission_.machine().set_contact(vehicle_.stopped());
    mission_.machine().set_battery(std::max(0.0, 1 - t_s / config_.flight.battery_s));
    command_ = mission_.step(next_command_ns_);
    commands_.push_back({t_s + config_.flight.latency_s, {command_.velocity_mps, command_.yaw_rate_radps}});
    note_end(next_command_ns_);
    next_command_ns_ += to_nanoseconds(1 / config_.flight.command_rate_hz);
  }
}

void LandingFlight::Impl::fly_to(double t_s) {
  while (vehicle_.now_s() <= t_s && !over()) {
    const double now_s = vehicle_.now_s();
    while (!commands_.empty() && commands_.front().first <= now_s) {
      vehicle_.command(commands_.front().second);
      commands_.pop_front();
    }
    vehicle_.advance_to(now_s);
    if (!vehicle_.stopped()) touch();
    if (track_.empty() || now_s >= track_.back().t_s + kTrackPeriod_s) {
      track_.push_back({now_s, vehicle_.p_world(), command_.state});
      if (!vehicle_.stopped()) look_for_collisions();
    }
  }
}

/// The skids meet the highest thing below them.
void LandingFlight::Impl::touch() {
  const Eigen::Vector3d& p = vehicle_.p_world();
  const double low_m = p.z() - config_.flight.skid_height_m;
  const double radius_m = config_.flight.skid_radius_m;
  const bool met =
      low_m <= highest_m(truth_, p.head<2>(), radius_m) ||
      (!world_.movers().empty() && reached_from_below(renderer_, p, radius_m, low_m, vehicle_.now_s()));
  if (!met) return;
  vehicle_.stop();
  if (command_.state == MissionState::kFinalDescent) return;
  ended_ = true;
  outcome_ = Outcome::kCollided;
  reason_ = std::string("met the ground or something on it in state ") + name(command_.state);
}

/// The rim of the body sweeps the air: whatever lies between where it was and where it is was hit.
void LandingFlight::Impl::look_for_collisions() {
  constexpr int kPoints = 192;  // 2.8 cm apart
  std::vector<Eigen::Vector3d> rim(kPoints);
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * kPi * i / kPoints;
    rim[static_cast<std::size_t>(i)] =
        vehicle_.p_world() +
        config_.flight.body_radius_m * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0);
  }
  if (!ring_.empty()) {
    std::vector<Eigen::Vector3d> way(rim.size());
    for (std::size_t i = 0; i < rim.size(); ++i) way[i] = rim[i] - ring_[i];
    const double length_m = way.front().norm();
    std::vector<sim::Hit> hits;
    const std::vector<double> times_s(rim.size(), vehicle_.now_s());
    if (length_m > 1e-6) renderer_.cast_many(ring_, way, hits, times_s);
    for (const sim::Hit& hit : hits) {
      if (!hit.hit || hit.range_m > length_m) continue;
      vehicle_.stop();
      ended_ = true;
      outcome_ = Outcome::kCollided;
      reason_ =
          std::string("hit ") + sim::properties(hit.material).name + " in state " + name(command_.state);
      break;
    }
  }
  ring_ = std::move(rim);
}

void LandingFlight::Impl::note_end(std::int64_t t_ns) {
  end_s_ = to_seconds(true_ns(t_ns));
  if (ended_) return;
  if (command_.state == MissionState::kTouchdown) {
    ended_ = true;
    const Eigen::Vector3d& p = vehicle_.p_world();
    if (!world_.movers().empty()) end_truth_.emplace(renderer_, config_.surface_truth, end_s_);
    const bool safe = surface_truth().clearance_m(p.x(), p.y()) >= config_.flight.body_radius_m;
    outcome_ = safe ? Outcome::kSafe : Outcome::kUnsafe;
    reason_ = command_.reason;
  } else if (command_.state == MissionState::kGivenUp && command_.since_s >= kAfterGivingUp_s) {
    ended_ = true;
    reason_ = command_.reason;
  }
}

FlownLanding LandingFlight::Impl::fly(sim::BagWriter* bag) {
  for (const sim::ScheduledMessage& message : sim::message_schedule(sensors_, longest_s_)) {
    if (over()) break;
    const bool camera = message.stream == sim::SensorStream::kCamera;
    if (camera && !config_.flight.images) continue;
    if (message.stream == sim::SensorStream::kImu && bag == nullptr) continue;
    deliver_until(start_ns_ + message.receive_ns - 1);
    if (over()) break;
    fly_to(to_seconds(message.receive_ns));
    for (const sim::RecordedMessage& made : measure(message)) {
      if (bag != nullptr) bag->write(made);
      send(made);
    }
  }
  if (!over()) reason_ = std::string("the longest flight is over in state ") + name(command_.state);
  FlownLanding flown;
  flown.result = result();
  flown.result.cost_s = processor_s() - begun_s_;
  track_.push_back({vehicle_.now_s(), vehicle_.p_world(), command_.state});
  flown.track = track_;
  flown.fence_m = config_.mission.geofence_radius_m;
  flown.fence_middle = start().head<2>();
  flown.clock_start_s = to_seconds(start_ns_);
  return flown;
}

LandingResult LandingFlight::Impl::result() const {
  LandingResult r;
  r.seed = static_cast<int>(seed_);
  r.look = sim::to_string(config_.world.look);
  if (fault_.fault != nullptr) {
    r.fault = fault_.fault->name;
    r.fault_s = fault_.at_s;
    r.fault_lasts_s = fault_.lasts_s;
  }
  r.lidar_only = lidar_only_;
  r.images = config_.flight.images;
  r.outcome = outcome_;
  r.reason = reason_;
  r.duration_s = end_s_ - automatic_s_;
  for (const auto& event : mission_.machine().events()) {
    r.attempts += event.to == MissionState::kFlyAbove ? 1 : 0;
    r.wandered += event.to == MissionState::kWander ? 1 : 0;
    r.climbed_away += event.to == MissionState::kClimbAway ? 1 : 0;
  }
  r.events = mission_.machine().events();
  const auto& target = mission_.machine().target();
  r.least_bad = target && target->least_bad;
  r.frames = frames_;
  r.frames_with_depth = frames_with_depth_;
  r.accumulation_s = frames_with_depth_ > 0 ? accumulation_s_ / frames_with_depth_ : 0;
  r.safe_radius_m = widest_safe_radius_m(truth_, start().head<2>(), config_.mission.geofence_radius_m);
  r.p_end = vehicle_.p_world();
  if (r.landed()) {
    r.footprint = measure_footprint(surface_truth(), r.p_end.head<2>(), config_.flight.body_radius_m);
    if (target && mission_.p_world())
      r.miss_m = (*mission_.p_world() - target->place.p_world).head<2>().norm();
  }
  return r;
}

LandingFlight::LandingFlight(const LandConfig& config, std::int64_t seed,
                             std::shared_ptr<DepthPredictor> predictor, const PlannedFault& fault)
    : impl_(std::make_unique<Impl>(config, seed, std::move(predictor), fault)) {}
LandingFlight::~LandingFlight() = default;
FlownLanding LandingFlight::fly(sim::BagWriter* bag) { return impl_->fly(bag); }
const sim::SurfaceTruth& LandingFlight::surface_truth() const { return impl_->surface_truth(); }

}  // namespace alight::closed_loop
