#include "infer/mission/mission_machine.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

using S = MissionState;
using G = Guard;

constexpr double kPositionGain_per_s = 0.8;
constexpr double kSearchHeightTolerance_m = 0.7;
constexpr double kConfirmHeightTolerance_m = 0.3;
constexpr double kSamePlace_m = 3.0;
constexpr std::size_t kMaxRemembered = 64;
/// Sideways way for which a place has to be wider by a metre.
constexpr double kWayPerRadius = 40.0;

double horizontal_m(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return (a - b).head<2>().norm(); }

}  // namespace

MissionMachine::MissionMachine(const MissionConfig& config)
    : config_(config), wander_(config.geofence_radius_m, config.wander_spacing_m) {}

double MissionMachine::since_s(std::int64_t t_ns) const { return to_seconds(now_ns_ - t_ns); }

void MissionMachine::set_position(std::int64_t t_ns, const Eigen::Vector3d& p_world) {
  now_ns_ = std::max(now_ns_, t_ns);
  if (p_world.allFinite()) p_world_ = p_world;
}

void MissionMachine::set_health(const HealthReport& health) {
  health_failed_ = health.state == HealthState::kFailed;
  health_text_ = describe(health);
}

bool MissionMachine::wants_target() const {
  return state_ == S::kFlyAbove || state_ == S::kDescend || state_ == S::kConfirm ||
         state_ == S::kFinalDescent;
}

double MissionMachine::horizontal_to_target_m() const {
  return horizontal_m(*p_world_, target_->place.p_world);
}

double MissionMachine::height_over_target_m() const { return p_world_->z() - target_->place.p_world.z(); }

std::optional<SiteCheckRule> MissionMachine::check_rule() const {
  if (!target_ || !wants_target() || !p_world_) return std::nullopt;
  SiteCheckRule rule;
  rule.radius_m = target_->least_bad ? config_.least_bad_radius_m : config_.keep_radius_m;
  if (state_ == S::kFinalDescent) {
    rule.min_known_share = 0.05;  // of a circle that outgrows the LiDAR's
  } else {
    const double moved_m = horizontal_m(target_->place.p_world, target_->chosen_p_world);
    rule.nudge_m = std::max(0.0, config_.nudge_m - moved_m);
  }
  return rule;
}

bool MissionMachine::usable(const Place& place) const {
  if (!place.p_world.allFinite()) return false;
  if (horizontal_m(place.p_world, home_) > config_.geofence_radius_m) return false;
  return std::none_of(rejected_.begin(), rejected_.end(), [&](const Place& gone) {
    return horizontal_m(gone.p_world, place.p_world) < config_.rejected_radius_m;
  });
}

/// Of places that are one, the latest look counts.
void MissionMachine::remember(const Place& place) {
  const auto same = std::find_if(remembered_.begin(), remembered_.end(), [&](const Place& known) {
    return horizontal_m(known.p_world, place.p_world) < kSamePlace_m;
  });
  if (same != remembered_.end()) {
    *same = place;
    return;
  }
  remembered_.push_back(place);
  if (remembered_.size() <= kMaxRemembered) return;
  remembered_.erase(std::min_element(remembered_.begin(), remembered_.end(),
                                     [](const Place& a, const Place& b) { return a.radius_m < b.radius_m; }));
}

std::optional<Place> MissionMachine::least_bad() const {
  std::optional<Place> best;
  double best_score = 0;
  for (const Place& place : remembered_) {
    if (place.radius_m < config_.least_bad_radius_m || !usable(place) || !p_world_) continue;
    const double score = place.radius_m - horizontal_m(place.p_world, *p_world_) / kWayPerRadius;
    if (best && score <= best_score) continue;
    best = place;
    best_score = score;
  }
  return best;
}

void MissionMachine::add(std::int64_t t_ns, const FrameEvidence& frame) {
  now_ns_ = std::max(now_ns_, t_ns);
  accepted_.reset();
  if (frame.age_s > config_.max_evidence_age_s) return;
  if (frame.accepted && usable(*frame.accepted)) {
    accepted_ = frame.accepted;
    accepted_ns_ = now_ns_;
  }
  if (frame.largest && usable(*frame.largest)) remember(*frame.largest);
  if (target_ && wants_target()) judge_target(frame);
}

void MissionMachine::judge_target(const FrameEvidence& frame) {
  const SiteCheck check = frame.check.value_or(SiteCheck{});
  const std::string text = fmt::format("free radius {:.2f} m, {:.0f} % of it known, {:.0f} % of that unsafe",
                                       check.radius_m, 100 * check.known_share, 100 * check.unsafe_share);
  last_check_ = frame.check ? text : "no depth";
  switch (check.verdict) {
    case SiteVerdict::kSafe:
      seen_safe_ns_ = now_ns_;
      unsafe_in_row_ = 0;
      if (horizontal_m(check.p_world, target_->place.p_world) > 0.3) confirmed_in_row_ = 0;
      target_->place.p_world = check.p_world;
      target_->place.radius_m = check.radius_m;
      if (state_ == S::kConfirm && frame.dense_lidar) ++confirmed_in_row_;
      return;
    case SiteVerdict::kUnsafe:
      ++unsafe_in_row_;
      confirmed_in_row_ = 0;
      return;
    case SiteVerdict::kUnseen:
      confirmed_in_row_ = 0;
      // Far off to the side nothing can be expected to be seen.
      if (state_ == S::kFlyAbove && horizontal_to_target_m() > 0.2 * height_over_target_m())
        seen_safe_ns_ = now_ns_;
  }
}

bool MissionMachine::timed_out() const {
  for (const StateTimeout& row : state_timeouts()) {
    if (row.state == state_) return since_s(entered_ns_) > config_.*row.limit_s;
  }
  return false;
}

bool MissionMachine::energy_low() const {
  return charge_ <= config_.battery_low || (automatic_ns_ && since_s(*automatic_ns_) > config_.time_low_s);
}

bool MissionMachine::energy_critical() const {
  return charge_ <= config_.battery_critical ||
         (automatic_ns_ && since_s(*automatic_ns_) > config_.time_critical_s);
}

GuardSet MissionMachine::guards() const {
  GuardSet set = 0;
  const auto put = [&](Guard guard, bool holds) { set |= holds ? bit(guard) : GuardSet{0}; };
  // Without a position nobody can fly automatically.
  put(G::kManual, manual_ || !p_world_);
  put(G::kAbort, abort_);
  put(G::kHealthFailed, health_failed_);
  put(G::kContact, contact_);
  const std::optional<Place> site = fresh_site();
  put(G::kSiteAccepted, site && !near_below(*site));
  put(G::kSearchTooLow,
      site && near_below(*site) && p_world_->z() < search_z_for(*site) - 2 * kSearchHeightTolerance_m);
  put(G::kTargetUnsafe, unsafe_in_row_ >= config_.unsafe_frames);
  put(G::kTargetLost, since_s(seen_safe_ns_) > config_.site_timeout_s);
  if (p_world_ && target_) {
    put(G::kAboveTarget, horizontal_to_target_m() <= config_.above_tolerance_m);
    put(G::kAtConfirmHeight, height_over_target_m() <= config_.confirm_height_m + kConfirmHeightTolerance_m);
    put(G::kCommitted, height_over_target_m() <= config_.commit_height_m);
  }
  put(G::kConfirmedDense, confirmed_in_row_ >= config_.confirm_frames);
  put(G::kAtSearchHeight, p_world_ && p_world_->z() >= home_.z() - kSearchHeightTolerance_m);
  put(G::kEnergyLow, energy_low());
  put(G::kEnergyCritical, energy_critical());
  put(G::kLeastBadKnown, least_bad().has_value());
  put(G::kTimeout, timed_out());
  return set;
}

std::string MissionMachine::reason_for(const Transition& row) const {
  std::string reason = row.reason;
  const auto uses = [&](Guard guard) { return (row.when & bit(guard)) != 0; };
  if (health_failed_ && (uses(G::kHealthFailed) || state_ == S::kHold)) reason += ": " + health_text_;
  if (uses(G::kTargetUnsafe) || uses(G::kTargetLost) || (uses(G::kTimeout) && state_ == S::kConfirm))
    reason += " (" + last_check_ + ")";
  if (uses(G::kSearchTooLow))
    reason += fmt::format(" ({:.1f} m over it)", p_world_->z() - accepted_->p_world.z());
  if (uses(G::kEnergyLow) || uses(G::kEnergyCritical)) {
    reason += fmt::format(" (battery {:.0f} %", 100 * charge_) +
              fmt::format(", {:.0f} s in automatic mode)", automatic_ns_ ? since_s(*automatic_ns_) : 0.0);
  }
  return reason;
}

/// A site that the vehicle turns away from is not chosen again.
void MissionMachine::leave_target(MissionState to) {
  const bool goes_on =
      to == S::kDescend || to == S::kConfirm || to == S::kFinalDescent || to == S::kTouchdown;
  if (goes_on || !target_) return;
  const bool blameless = to == S::kManual || health_failed_ || abort_;
  if (!blameless) rejected_.push_back(target_->place);
  target_.reset();
}

std::optional<Place> MissionMachine::fresh_site() const {
  return since_s(accepted_ns_) <= config_.max_evidence_age_s ? accepted_ : std::nullopt;
}

/// From so near nobody sees how the ground goes on around a place.
bool MissionMachine::near_below(const Place& place) const {
  return p_world_ && p_world_->z() - place.p_world.z() < config_.choose_height_m;
}

/// The search height from which a place may be chosen. What seems to be near below however high the vehicle goes
/// (rain, something that hangs from it) does not lead it up for ever.
double MissionMachine::search_z_for(const Place& place) const {
  const double wanted_m = place.p_world.z() + config_.choose_height_m + 2 * kSearchHeightTolerance_m;
  return std::max(home_.z(), std::min(wanted_m, begun_z_m_ + config_.choose_height_m));
}

/// The site that counts; where none does, the least bad one, which only low energy leads to.
void MissionMachine::choose() {
  const std::optional<Place> site = fresh_site();
  const bool counts = site && !near_below(*site);
  MissionTarget target;
  target.least_bad = !counts;
  target.place = counts ? *site : *least_bad();
  target.chosen_p_world = target.place.p_world;
  target_ = target;
}

void MissionMachine::enter(MissionState state, const std::string& reason) {
  leave_target(state);
  if (state == S::kFlyAbove) choose();
  if (state_ == S::kManual) {
    automatic_ns_ = now_ns_;
    home_ = *p_world_;
    begun_z_m_ = home_.z();
    way_m_ = 0;
    rejected_.clear();
    remembered_.clear();
    accepted_.reset();
  }
  // Sensors that failed may have moved the world: what was seen before does not hold.
  if (state == S::kHold) {
    remembered_.clear();
    accepted_.reset();
  }
  if (state == S::kManual) automatic_ns_.reset();
  events_.push_back({now_ns_, state_, state, reason});
  state_ = state;
  reason_ = reason;
  entered_ns_ = now_ns_;
  seen_safe_ns_ = now_ns_;
  unsafe_in_row_ = 0;
  confirmed_in_row_ = 0;
  if (p_world_) hold_ = *p_world_;
}

Eigen::Vector3d MissionMachine::wander_point() const {
  Eigen::Vector3d point = home_;
  point.head<2>() += wander_.at(way_m_);
  return point;
}

/// The point to follow runs ahead at search speed and waits for a vehicle that falls behind.
void MissionMachine::wander_on(double passed_s) {
  if (horizontal_m(*p_world_, wander_point()) > 2 * config_.wander_speed_mps) return;
  way_m_ += config_.wander_speed_mps * std::clamp(passed_s, 0.0, 1.0);
}

Eigen::Vector3d MissionMachine::towards(const Eigen::Vector3d& p_world, double speed_mps) const {
  const Eigen::Vector3d velocity = kPositionGain_per_s * (p_world - *p_world_);
  const double norm = velocity.norm();
  return norm > speed_mps ? Eigen::Vector3d(velocity * (speed_mps / norm)) : velocity;
}

Eigen::Vector3d MissionMachine::inside_fence(Eigen::Vector3d velocity_mps) const {
  const Eigen::Vector2d out = (*p_world_ - home_).head<2>();
  if (out.norm() < config_.geofence_radius_m) return velocity_mps;
  const Eigen::Vector2d outwards = out.normalized();
  const double speed = velocity_mps.head<2>().dot(outwards);
  if (speed > 0) velocity_mps.head<2>() -= speed * outwards;
  return velocity_mps;
}

Eigen::Vector3d MissionMachine::velocity() const {
  switch (state_) {
    case S::kManual:
    case S::kTouchdown:
      break;
    case S::kSelect:
    case S::kHold:
      // Without a position the last one says nothing: stand still by the autopilot's own means.
      return health_failed_ ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                            : towards(hold_, config_.fly_speed_mps);
    case S::kWander: {
      Eigen::Vector3d velocity = towards(wander_point(), 1.5 * config_.wander_speed_mps);
      velocity.z() =
          std::clamp(kPositionGain_per_s * (home_.z() - p_world_->z()), -1.0, config_.climb_speed_mps);
      return velocity;
    }
    case S::kFlyAbove: {
      Eigen::Vector3d goal = target_->place.p_world;
      goal.z() = hold_.z();
      return towards(goal, config_.fly_speed_mps);
    }
    case S::kDescend:
    case S::kConfirm: {
      Eigen::Vector3d goal = target_->place.p_world;
      goal.z() += config_.confirm_height_m;
      Eigen::Vector3d velocity = towards({goal.x(), goal.y(), p_world_->z()}, config_.fly_speed_mps);
      const bool aside = horizontal_to_target_m() > 2 * config_.above_tolerance_m;
      const double down_mps =
          std::clamp(kPositionGain_per_s * (p_world_->z() - goal.z()), -1.0, config_.descent_speed_mps);
      velocity.z() = aside && down_mps > 0 ? 0 : -down_mps;
      return velocity;
    }
    case S::kFinalDescent: {
      const Eigen::Vector3d& goal = target_->place.p_world;
      Eigen::Vector3d velocity = towards({goal.x(), goal.y(), p_world_->z()}, 1.0);
      velocity.z() =
          -std::clamp(0.3 * height_over_target_m(), config_.touchdown_speed_mps, config_.final_speed_mps);
      return velocity;
    }
    case S::kClimbAway:
    case S::kGivenUp: {
      const double up_m = home_.z() - p_world_->z();
      // A position that is lost stays low for ever: then the way up is counted in time.
      const double way_s = (home_.z() - hold_.z()) / config_.climb_speed_mps;
      const bool counted_up = state_ == S::kGivenUp || since_s(entered_ns_) > way_s + 1.0;
      const double up_mps =
          health_failed_ && counted_up ? 0.0 : std::clamp(up_m, 0.0, config_.climb_speed_mps);
      return {0, 0, up_mps};
    }
  }
  return Eigen::Vector3d::Zero();
}

MissionCommand MissionMachine::step(std::int64_t t_ns) {
  now_ns_ = std::max(now_ns_, t_ns);
  const double passed_s = stepped_ns_ ? since_s(*stepped_ns_) : 0.0;
  stepped_ns_ = now_ns_;
  if (const Transition* row = next_transition(state_, guards())) {
    const std::string reason = reason_for(*row);
    if ((row->when & bit(G::kSearchTooLow)) != 0) home_.z() = search_z_for(*fresh_site());
    enter(row->to, reason);
  }
  abort_ = false;

  MissionCommand command;
  command.state = state_;
  command.reason = reason_;
  command.since_s = since_s(entered_ns_);
  command.fly = state_ != S::kManual && state_ != S::kTouchdown;
  command.motors_off = state_ == S::kTouchdown;
  command.target = target_;
  if (state_ == S::kWander) wander_on(passed_s);
  if (command.fly) command.velocity_mps = inside_fence(velocity());
  return command;
}

}  // namespace alight
