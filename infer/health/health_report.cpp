#include "infer/health/health_report.hpp"

#include <algorithm>

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

bool same_findings(const HealthReport& a, const HealthReport& b) {
  return a.state == b.state &&
         std::equal(a.findings.begin(), a.findings.end(), b.findings.begin(), b.findings.end(),
                    [](const HealthFinding& x, const HealthFinding& y) {
                      return x.sensor == y.sensor && x.fault == y.fault;
                    });
}

std::string describe(const HealthReport& report) {
  std::string text;
  for (const HealthFinding& finding : report.findings) {
    text += (text.empty() ? "" : ", ") + finding.sensor + " " + finding.fault;
  }
  return text;
}

}  // namespace alight
