#include "infer/health/pose_watch.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr double kLongestGap_s = 0.1;    // as the engine's: no pose is known inside a longer one
constexpr double kVelocityOver_s = 0.2;  // long enough for noise, short enough for a multirotor's turns
constexpr double kStepOver_s = 0.1;      // limits hold for steps as short as this and grow with longer ones
constexpr double kTurnOver_s = 0.02;

}  // namespace

PoseWatch::PoseWatch(const HealthConfig& config)
    : config_(config),
      trajectory_(kLongestGap_s),
      attitude_jump_("attitude", "jump"),
      position_jump_("position", "jump"),
      attitude_frozen_("attitude", "frozen"),
      position_frozen_("position", "frozen") {}

double PoseWatch::Repetition::add(std::int64_t t_ns, bool same) {
  if (!same) {
    varied_ = varied_ || since_ns_.has_value();
    since_ns_ = t_ns;
  }
  if (!since_ns_) since_ns_ = t_ns;
  return varied_ ? to_seconds(t_ns - *since_ns_) : 0;
}

bool PoseWatch::add(const AttitudeSample& sample) {
  if (!trajectory_.add_attitude(sample.t_ns, sample.q_world_imu)) return false;
  bool jump = false;
  bool same = false;
  if (attitude_) {
    const double turn_deg = to_degrees(attitude_->q_world_imu.angularDistance(sample.q_world_imu));
    const double dt_s = to_seconds(sample.t_ns - attitude_->t_ns);
    jump = turn_deg > config_.pose.max_turn_deg * std::max(1.0, dt_s / kTurnOver_s);
    same = attitude_->q_world_imu.coeffs() == sample.q_world_imu.coeffs();
    const std::string reason = fmt::format("turned by {:.1f} deg in {:.3f} s", turn_deg, dt_s);
    if (jump) attitude_jump_.raise(sample.t_ns, reason);
  }
  if (!jump) attitude_jump_.look(config_, sample.t_ns, false, "");
  const double same_s = same_attitude_.add(sample.t_ns, same);
  attitude_frozen_.look(config_, sample.t_ns, same_s > config_.pose.frozen_s,
                        fmt::format("the same value for {:.2f} s", same_s));
  attitude_ = sample;
  return jump;
}

bool PoseWatch::add(const PositionSample& sample) {
  const Eigen::Vector3d p_world = world_.to_world(sample);
  if (!trajectory_.add_position(sample.t_ns, p_world)) return false;
  bool jump = false;
  bool same = false;
  if (!places_.empty()) {
    const Place& first = places_.front();
    const Place& last = places_.back();
    const double dt_s = to_seconds(sample.t_ns - last.t_ns);
    const double span_s = to_seconds(last.t_ns - first.t_ns);
    Eigen::Vector3d p_expected = last.p_world;
    if (span_s > 0) p_expected += (last.p_world - first.p_world) * (dt_s / span_s);
    const double off_m = (p_world - p_expected).norm();
    jump = off_m > config_.pose.max_position_step_m * std::max(1.0, dt_s / kStepOver_s);
    same = p_world == last.p_world;
    if (jump) {
      position_jump_.raise(sample.t_ns, fmt::format("{:.2f} m off the way so far, at most {:.2f} m expected",
                                                    off_m, config_.pose.max_position_step_m));
      places_.clear();
    }
  }
  if (!jump) position_jump_.look(config_, sample.t_ns, false, "");
  const double same_s = same_position_.add(sample.t_ns, same);
  position_frozen_.look(config_, sample.t_ns, same_s > config_.pose.frozen_s,
                        fmt::format("the same value for {:.2f} s", same_s));
  places_.push_back({sample.t_ns, p_world});
  while (to_seconds(sample.t_ns - places_.front().t_ns) > kVelocityOver_s) places_.pop_front();
  return jump;
}

bool PoseWatch::usable() const {
  return !attitude_jump_.present() && !position_jump_.present() && !attitude_frozen_.present() &&
         !position_frozen_.present();
}

void PoseWatch::report(std::vector<HealthFinding>& findings) const {
  for (const Symptom* symptom : {&attitude_jump_, &attitude_frozen_, &position_jump_, &position_frozen_})
    symptom->report(findings);
}

std::optional<Eigen::Vector3d> PoseWatch::p_world() const {
  if (places_.empty()) return std::nullopt;
  return places_.back().p_world;
}

}  // namespace alight
