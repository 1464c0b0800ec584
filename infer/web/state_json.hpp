#pragma once

#include <memory>
#include <string>
#include <vector>

#include "infer/onboard/engine_runner.hpp"
#include "infer/onboard/mode_switch.hpp"
#include "infer/web/flight_view.hpp"
#include "infer/web/shown_frame.hpp"

namespace alight {

/// Where the search for a landing place stands.
enum class LandingState { kLooking, kTracking, kAccepted, kWandering, kNoDepth };
/// "looking", "tracking", "accepted", "wandering", "no_depth"
const char* name(LandingState state);
LandingState landing_state(const FrameReport& report);

/// "automatic", "manual"
const char* name(FlightMode mode);

/// One frame's part of the state: its line of results.jsonl, landing state, depth scale, health.
std::string frame_json(const FrameReport& report, const FrameStyle& style);

/// All that is not of one frame.
struct LiveState {
  std::string run;  ///< another value: another flight, counting starts anew
  FlightMode mode = FlightMode::kManual;
  double max_rate_hz = 0;
  std::vector<SensorStatus> sensors;
  RunnerStatistics statistics;
  std::vector<HistorySample> history;
  std::shared_ptr<const ShownFrame> frame;  ///< null before the first result
};
/// The whole answer to a request for the state (docs/ground_station.md). Values that do not exist are null.
std::string state_json(const LiveState& state);

}  // namespace alight
