#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "sensors/stream/flight_log.hpp"

namespace alight {

/// A flight log, over and over if asked: the times of a round go on where the round before ended. For endurance tests;
/// between two rounds the vehicle jumps.
class LoopedLog {
 public:
  /// @throws as FlightLog
  LoopedLog(std::filesystem::path path, const Rig& rig, const LogConfig& config, int rounds);

  /// As FlightLog's.
  bool next(LogMessage& out);
  std::int64_t receive_ns() const { return log_->receive_ns() + offset_ns_; }
  /// Messages consumed and to be consumed, over all rounds; for progress bars.
  std::int64_t consumed() const { return consumed_before_ + log_->consumed(); }
  std::int64_t messages() const { return log_->summary().messages * rounds_; }
  /// What was left out while reading, over all rounds.
  std::map<std::string, std::int64_t> dropped() const;

 private:
  bool begin_next_round();

  std::filesystem::path path_;
  Rig rig_;
  LogConfig config_;
  int rounds_;
  int round_ = 1;
  std::optional<FlightLog> log_;
  std::int64_t offset_ns_ = 0;
  std::int64_t consumed_before_ = 0;
  std::map<std::string, std::int64_t> dropped_before_;
};

}  // namespace alight
