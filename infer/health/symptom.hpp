#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "infer/health/health_config.hpp"
#include "infer/health/health_report.hpp"

namespace alight {

/// Makes a finding of repeated signs, so that one damaged message is none: signs that follow one another for
/// `confirm_s` raise it, `recover_s` without a sign ends it.
class Symptom {
 public:
  Symptom(std::string sensor, std::string fault) : finding_{std::move(sensor), std::move(fault), "", 0} {}

  /// One look at the sensor. @param reason is read where `present` only
  void look(const HealthConfig& config, std::int64_t t_ns, bool present, const std::string& reason);
  /// A fault that is certain at once.
  void raise(std::int64_t t_ns, const std::string& reason);
  void clear();

  bool present() const { return confirmed_; }
  /// The last look saw a sign, confirmed or not.
  bool suspected() const { return first_ns_.has_value(); }
  const HealthFinding& finding() const { return finding_; }
  void report(std::vector<HealthFinding>& findings) const {
    if (confirmed_) findings.push_back(finding_);
  }

 private:
  HealthFinding finding_;
  bool confirmed_ = false;
  std::optional<std::int64_t> first_ns_;  // of the signs that follow one another
  std::int64_t last_ns_ = 0;              // latest sign
};

}  // namespace alight
