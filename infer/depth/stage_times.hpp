#pragma once

#include <chrono>
#include <map>
#include <string>
#include <utility>

namespace alight {

/// Wall-clock milliseconds by stage. Information only: no result depends on it.
using StageTimes = std::map<std::string, double>;

/// Adds its lifetime to a stage.
class StageTimer {
 public:
  StageTimer(StageTimes& times, std::string stage)
      : times_(times), stage_(std::move(stage)), start_(std::chrono::steady_clock::now()) {}
  ~StageTimer() {
    times_[stage_] +=
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  StageTimes& times_;
  std::string stage_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace alight
