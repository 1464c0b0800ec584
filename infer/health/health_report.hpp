#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace alight {

/// How far the results may be relied on. The order is from good to bad.
enum class HealthState {
  kOk,
  kDegraded,  ///< a sensor is missing or doubtful; the others carry on, and what they say may be acted on
  kFailed,    ///< nothing that could be acted on; no site is reported
};
/// "ok", "degraded", "failed"
const char* name(HealthState state);

/// One thing that is wrong.
struct HealthFinding {
  std::string sensor;  ///< "left camera", "right camera", "stereo", "lidar", "attitude", "position", "height"
  std::string fault;   ///< one or two words: "lost", "frozen", "black"
  std::string reason;  ///< for people: what was measured and what was expected
  std::int64_t since_ns = 0;  ///< message time at which it was first seen
};

/// The sensors' health at the moment of a result.
struct HealthReport {
  HealthState state = HealthState::kOk;
  std::vector<HealthFinding> findings;  ///< empty when kOk
};

/// Whether both name the same state, sensors and faults. Reasons hold figures that change from message to message.
bool same_findings(const HealthReport& a, const HealthReport& b);

/// "lidar lost, left camera black"; empty without findings.
std::string describe(const HealthReport& report);

}  // namespace alight
