#include "infer/health/health_report.hpp"

namespace alight {

const char* name(HealthState state) {
  switch (state) {
    case HealthState::kOk:
      break;
    case HealthState::kDegraded:
      return "degraded";
    case HealthState::kFailed:
      return "failed";
  }
  return "ok";
}

}  // namespace alight
