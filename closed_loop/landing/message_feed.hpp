#pragma once

#include <map>
#include <string>
#include <vector>

#include "sensors/stream/message_assembler.hpp"
#include "sim/record/message_maker.hpp"

namespace alight::closed_loop {

/// The simulated messages as the engine gets them: serialised, and through the very decoders that read a log, so that the
/// bag of a landing replays to the same results.
class MessageFeed {
 public:
  MessageFeed(const Rig& rig, const LogConfig& config);

  /// @returns what became complete with this message; nothing for topics that the engine does not read
  std::vector<LogMessage> add(const sim::RecordedMessage& message);

 private:
  std::map<std::string, Sensor> sensors_;  // by topic
  MessageAssembler assembler_;
};

}  // namespace alight::closed_loop
