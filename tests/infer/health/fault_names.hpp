#pragma once

#include <string>
#include <vector>

#include "infer/health/health_report.hpp"

namespace alight::test {

using FaultNames = std::vector<std::string>;

/// What a watch reports, as "sensor fault".
template <class Watch>
FaultNames fault_names(const Watch& watch) {
  std::vector<HealthFinding> findings;
  watch.report(findings);
  FaultNames names;
  for (const HealthFinding& finding : findings) names.push_back(finding.sensor + " " + finding.fault);
  return names;
}

}  // namespace alight::test
