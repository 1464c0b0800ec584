#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "infer/health/health_report.hpp"
#include "infer/mission/mission_config.hpp"
#include "infer/mission/mission_state.hpp"
#include "infer/mission/mission_table.hpp"
#include "infer/mission/site_check.hpp"
#include "infer/mission/wander_path.hpp"

namespace alight {

/// A safe circle on the ground. Frame: world.
struct Place {
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

/// What one result says to a landing.
struct FrameEvidence {
  double age_s = 0;               ///< of its image when it is told
  bool dense_lidar = false;       ///< its depth is LiDAR alone, a full window of it
  std::optional<Place> accepted;  ///< the site that counts, by the five-frame rule
  std::optional<Place> largest;   ///< the frame's largest circle, whatever its size
  std::optional<SiteCheck>
      check;  ///< of MissionMachine::target(), where there is one and depth to judge it by
};

/// The place that the vehicle goes to.
struct MissionTarget {
  Place place;
  Eigen::Vector3d chosen_p_world = Eigen::Vector3d::Zero();  ///< where it was first
  bool least_bad = false;                                    ///< taken because energy ran low
};

/// What the autopilot is asked to do. Velocities are what a simple vehicle follows; `p_world`, where there is one, is the
/// same wish as a position.
struct MissionCommand {
  MissionState state = MissionState::kManual;
  std::string reason;       ///< why this state was entered, with figures
  double since_s = 0;       ///< time in it
  bool fly = false;         ///< false: nothing is commanded (manual, touchdown)
  bool motors_off = false;  ///< landed
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< world
  double yaw_rate_radps = 0;
  std::optional<Eigen::Vector3d> p_world;
  std::optional<MissionTarget> target;
};

/// The landing as a state machine (mission_table.hpp). Knows no clock: every input carries its time, and the same inputs
/// give the same commands. Heights and places are in the world frame of the poses that it is given.
class MissionMachine {
 public:
  explicit MissionMachine(const MissionConfig& config);

  /// Times must not decrease; an input that comes with an earlier time counts as of the latest one.
  void set_position(std::int64_t t_ns, const Eigen::Vector3d& p_world);
  void set_manual(bool manual) { manual_ = manual; }
  void set_health(const HealthReport& health);
  void set_contact(bool contact) { contact_ = contact; }
  /// @param charge share of a full battery, 0..1
  void set_battery(double charge) { charge_ = charge; }
  void abort() { abort_ = true; }
  void add(std::int64_t t_ns, const FrameEvidence& frame);

  /// Time has passed: at most one transition is taken.
  MissionCommand step(std::int64_t t_ns);

  MissionState state() const { return state_; }
  /// How the target is to be judged now; empty without target.
  std::optional<SiteCheckRule> check_rule() const;
  const std::optional<MissionTarget>& target() const { return target_; }
  /// Every transition so far.
  struct Event {
    std::int64_t t_ns = 0;
    MissionState from = MissionState::kManual;
    MissionState to = MissionState::kManual;
    std::string reason;
  };
  const std::vector<Event>& events() const { return events_; }

 private:
  GuardSet guards() const;
  void enter(MissionState state, const std::string& reason);
  void leave_target(MissionState to);
  std::optional<Place> fresh_site() const;
  bool near_below(const Place& place) const;
  double search_z_for(const Place& place) const;
  void choose();
  std::string reason_for(const Transition& row) const;
  void judge_target(const FrameEvidence& frame);
  void remember(const Place& place);
  std::optional<Place> least_bad() const;
  bool usable(const Place& place) const;
  bool timed_out() const;
  bool energy_low() const;
  bool energy_critical() const;
  bool wants_target() const;
  double height_over_target_m() const;
  double horizontal_to_target_m() const;
  double since_s(std::int64_t t_ns) const;
  Eigen::Vector3d wander_point() const;
  void wander_on(double passed_s);
  Eigen::Vector3d velocity() const;
  Eigen::Vector3d towards(const Eigen::Vector3d& p_world, double speed_mps) const;
  Eigen::Vector3d inside_fence(Eigen::Vector3d velocity_mps) const;

  MissionConfig config_;
  WanderPath wander_;
  MissionState state_ = MissionState::kManual;
  std::string reason_ = "a person flies";
  std::vector<Event> events_;
  std::int64_t now_ns_ = 0;
  std::optional<std::int64_t> stepped_ns_;
  std::int64_t entered_ns_ = 0;
  std::optional<std::int64_t> automatic_ns_;  // since when

  std::optional<Eigen::Vector3d> p_world_;
  Eigen::Vector3d home_ =
      Eigen::Vector3d::Zero();  // where automatic mode began: middle of the fence; z: search height
  double begun_z_m_ = 0;        // the search height that it began with
  Eigen::Vector3d hold_ = Eigen::Vector3d::Zero();  // where the state was entered
  bool manual_ = true;
  bool abort_ = false;
  bool contact_ = false;
  bool health_failed_ = false;
  std::string health_text_;
  double charge_ = 1.0;

  std::optional<Place> accepted_;
  std::int64_t accepted_ns_ = 0;
  std::optional<MissionTarget> target_;
  std::int64_t seen_safe_ns_ = 0;
  int unsafe_in_row_ = 0;
  int confirmed_in_row_ = 0;
  std::string last_check_;
  std::vector<Place> rejected_;
  std::vector<Place> remembered_;
  double way_m_ = 0;  // flown along the wander path
};

}  // namespace alight
