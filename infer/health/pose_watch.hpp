#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "geometry/trajectory.hpp"
#include "infer/health/symptom.hpp"
#include "sensors/messages/message_types.hpp"
#include "sensors/poses/world_frame.hpp"

namespace alight {

/// Whether attitude and position can be those of one vehicle: neither leaps nor stands still to the last bit.
class PoseWatch {
 public:
  explicit PoseWatch(const HealthConfig& config);

  /// @returns true if the sample leaps from those before it
  bool add(const AttitudeSample& sample);
  bool add(const PositionSample& sample);

  bool usable() const;
  void report(std::vector<HealthFinding>& findings) const;

  /// As the samples say; a leap is in it.
  const Trajectory& trajectory() const { return trajectory_; }
  void forget_before(std::int64_t t_ns) { trajectory_.forget_before(t_ns); }
  std::optional<Eigen::Vector3d> p_world() const;

 private:
  struct Place {
    std::int64_t t_ns;
    Eigen::Vector3d p_world;
  };
  /// The same value again and again, from a sensor that used to vary.
  class Repetition {
   public:
    /// @returns since when the value is the same, in seconds; 0 for a sensor that has never varied
    double add(std::int64_t t_ns, bool same);

   private:
    std::optional<std::int64_t> since_ns_;
    bool varied_ = false;
  };

  HealthConfig config_;
  Trajectory trajectory_;
  WorldFrame world_;
  std::deque<Place> places_;  // the last tenth of a second or two
  std::optional<AttitudeSample> attitude_;
  Repetition same_attitude_;
  Repetition same_position_;
  Symptom attitude_jump_;
  Symptom position_jump_;
  Symptom attitude_frozen_;
  Symptom position_frozen_;
};

}  // namespace alight
