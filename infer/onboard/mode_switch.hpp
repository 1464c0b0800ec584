#pragma once

#include <atomic>

namespace alight {

/// Who flies (paper 3.3): in automatic mode the autopilot follows the landing site; in manual mode a person flies, and
/// nothing is sent that could move the vehicle.
enum class FlightMode { kAutomatic, kManual };

/// The one switch that the ROS service, the ground-station page and the autopilot output share. Any thread may use it.
class ModeSwitch {
 public:
  explicit ModeSwitch(FlightMode mode = FlightMode::kManual) : mode_(mode) {}
  FlightMode get() const { return mode_; }
  void set(FlightMode mode) { mode_ = mode; }

 private:
  std::atomic<FlightMode> mode_;
};

}  // namespace alight
