#include "infer/replay/looped_log.hpp"

#include <utility>

namespace alight {
namespace {

constexpr std::int64_t kPauseBetweenRounds_ns = 50'000'000;

void shift(LogMessage& message, std::int64_t offset_ns) {
  std::visit([&](auto& typed) { typed.t_ns += offset_ns; }, message);
  if (auto* packet = std::get_if<LidarPacket>(&message)) {
    for (LidarReturn& echo : packet->returns) echo.t_ns += offset_ns;
  }
}

}  // namespace

LoopedLog::LoopedLog(std::filesystem::path path, const Rig& rig, const LogConfig& config, int rounds)
    : path_(std::move(path)),
      rig_(rig),
      config_(config),
      rounds_(rounds),
      log_(FlightLog(path_, rig, config)) {}

bool LoopedLog::next(LogMessage& out) {
  while (!log_->next(out)) {
    if (!begin_next_round()) return false;
  }
  if (offset_ns_ != 0) shift(out, offset_ns_);
  return true;
}

bool LoopedLog::begin_next_round() {
  if (round_ == rounds_) return false;
  ++round_;
  const LogSummary& ended = log_->summary();
  offset_ns_ += ended.end_ns - ended.begin_ns + kPauseBetweenRounds_ns;
  consumed_before_ += log_->consumed();
  dropped_before_ = dropped();
  log_.emplace(path_, rig_, config_);
  return true;
}

std::map<std::string, std::int64_t> LoopedLog::dropped() const {
  std::map<std::string, std::int64_t> all = dropped_before_;
  for (const auto& [reason, count] : log_->summary().dropped) all[reason] += count;
  return all;
}

}  // namespace alight
