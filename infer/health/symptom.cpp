#include "infer/health/symptom.hpp"

#include "geometry/frames.hpp"

namespace alight {

void Symptom::look(const HealthConfig& config, std::int64_t t_ns, bool present, const std::string& reason) {
  if (!present) {
    first_ns_.reset();
    if (confirmed_ && to_seconds(t_ns - last_ns_) >= config.recover_s) confirmed_ = false;
    return;
  }
  if (!first_ns_) first_ns_ = t_ns;
  last_ns_ = t_ns;
  finding_.reason = reason;
  if (!confirmed_ && to_seconds(t_ns - *first_ns_) >= config.confirm_s) {
    confirmed_ = true;
    finding_.since_ns = *first_ns_;
  }
}

void Symptom::raise(std::int64_t t_ns, const std::string& reason) {
  if (!confirmed_) finding_.since_ns = t_ns;
  confirmed_ = true;
  first_ns_ = t_ns;
  last_ns_ = t_ns;
  finding_.reason = reason;
}

void Symptom::clear() {
  confirmed_ = false;
  first_ns_.reset();
}

}  // namespace alight
