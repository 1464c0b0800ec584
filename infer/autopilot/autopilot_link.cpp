#include "infer/autopilot/autopilot_link.hpp"

#include <chrono>
#include <limits>
#include <utility>
#include <variant>

#include <spdlog/spdlog.h>

#include "foundation/errors.hpp"
#include "geometry/frames.hpp"
#include "infer/autopilot/landing_target.hpp"
#include "infer/autopilot/send_rule.hpp"

namespace alight {
namespace {

constexpr std::chrono::seconds kHeartbeatPeriod(1);
constexpr std::chrono::seconds kReconnectPeriod(1);
constexpr double kWarnings_hz = 0.1;

SteadyTime::duration duration(double s) {
  return std::chrono::duration_cast<SteadyTime::duration>(std::chrono::duration<double>(s));
}

/// A height has no stamp of its own; its time is the recorder's, which may be on another clock.
std::optional<std::int64_t> stamp_ns(const LogMessage& message) {
  if (std::holds_alternative<HeightSample>(message)) return std::nullopt;
  return std::visit([](const auto& m) { return m.t_ns; }, message);
}

}  // namespace

AutopilotLink::AutopilotLink(const AutopilotConfig& config, const RectifiedRig& rig, const ModeSwitch& mode)
    : config_(config),
      T_camera_imu_(rig.T_camera_imu),
      mode_(mode),
      target_rate_(config.max_rate_hz),
      framer_(static_cast<std::uint8_t>(config.system_id), static_cast<std::uint8_t>(config.component_id)),
      warning_rate_(kWarnings_hz) {
  if (!config_.connection) return;
  if (!parse_connection(*config_.connection))
    throw ConfigError("autopilot.connection: " + *config_.connection +
                      " is neither udp:host:port nor serial:device:baud");
  thread_ = std::thread([this] { run(); });
}

AutopilotLink::~AutopilotLink() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void AutopilotLink::on_message(const LogMessage& message) {
  const auto t_ns = stamp_ns(message);
  if (!t_ns || (newest_ns_ && *t_ns <= *newest_ns_)) return;
  newest_ns_ = t_ns;
  newest_came_ = steady_now();
}

double AutopilotLink::age_s(std::int64_t t_ns, SteadyTime now) const {
  if (!newest_ns_) return std::numeric_limits<double>::infinity();
  return to_seconds(*newest_ns_ - t_ns) + std::chrono::duration<double>(now - newest_came_).count();
}

void AutopilotLink::on_frame(const FrameReport& frame) {
  if (!config_.connection) return;
  const SteadyTime now = steady_now();
  const double age = age_s(frame.depth.t_ns, now);
  if (const char* reason = reason_to_withhold(frame, mode_.get(), age, config_.max_age_s))
    return withhold(reason);
  if (!target_rate_.allow(now)) return withhold("max_rate_hz");
  const LandingTarget target =
      landing_target(*frame.decision.site, frame.depth.t_ns, *frame.depth.T_world_camera, T_camera_imu_);
  {
    const std::lock_guard lock(mutex_);
    if (waiting_) ++statistics_.withheld["a newer one came before it was sent"];
    waiting_ = Waiting{target, now + duration(config_.max_age_s - age)};
  }
  changed_.notify_all();
}

AutopilotStatistics AutopilotLink::statistics() const {
  const std::lock_guard lock(mutex_);
  return statistics_;
}

void AutopilotLink::withhold(const char* reason) {
  const std::lock_guard lock(mutex_);
  ++statistics_.withheld[reason];
}

void AutopilotLink::run() {
  SteadyTime next_heartbeat = steady_now();
  std::unique_lock lock(mutex_);
  while (!ending_) {
    const bool due = steady_now() >= next_heartbeat;
    const std::optional<Waiting> target = std::exchange(waiting_, std::nullopt);
    if (!due && !target) {
      changed_.wait_until(lock, next_heartbeat);
      continue;
    }
    lock.unlock();
    if (target) send_target(*target);
    if (due) {
      send_heartbeat();
      next_heartbeat = steady_now() + kHeartbeatPeriod;
    }
    lock.lock();
  }
}

void AutopilotLink::send_heartbeat() {
  if (!send(encode(Heartbeat{}))) return;
  const std::lock_guard lock(mutex_);
  ++statistics_.heartbeats;
}

void AutopilotLink::send_target(const Waiting& waiting) {
  if (mode_.get() != FlightMode::kAutomatic) return withhold("manual mode");
  if (steady_now() > waiting.expires) return withhold("result too old");
  if (!send(encode(waiting.target))) return;
  const std::lock_guard lock(mutex_);
  ++statistics_.targets;
}

bool AutopilotLink::send(const MavlinkMessage& message) {
  try {
    if (!transport_) connect();
    if (transport_) transport_->send(framer_.frame(message));
  } catch (const DataError& error) {
    transport_.reset();
    report_failure(error.what());
    return false;
  }
  const std::lock_guard lock(mutex_);
  if (!transport_) {  // the next try is not due yet
    ++statistics_.failures;
    return false;
  }
  if (std::exchange(warned_, false)) spdlog::info("autopilot: sending to {} works", *config_.connection);
  statistics_.last_failure.clear();
  return true;
}

void AutopilotLink::connect() {
  const SteadyTime now = steady_now();
  if (tried_ && now < *tried_ + kReconnectPeriod) return;
  tried_ = now;
  transport_ = open_transport(*parse_connection(*config_.connection));
}

void AutopilotLink::report_failure(const std::string& what) {
  std::int64_t failures = 0;
  {
    const std::lock_guard lock(mutex_);
    failures = ++statistics_.failures;
    statistics_.last_failure = what;
  }
  if (!warning_rate_.allow(steady_now())) return;
  spdlog::warn("autopilot: {} ({} messages not sent so far)", what, failures);
  warned_ = true;
}

}  // namespace alight
