#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "dataset/messages/message_types.hpp"

namespace alight {

/// A message and when it came.
struct TimedMessage {
  std::int64_t receive_ns = 0;
  LogMessage message;
};
using Messages = std::vector<TimedMessage>;

/// What can break, and how it has to be noticed.
struct Fault {
  std::string name;    ///< for people
  std::string sensor;  ///< of the finding; empty: nothing can be found
  std::string finding;
  std::string state;  ///< "degraded" or "failed" with a network; empty: nothing can be found
  Messages (*inject)(const Messages& flight, std::int64_t from_ns);
};

/// Every fault: `inject` turns a healthy flight into one that breaks at `from_ns` and stays broken. Messages are in order
/// of arrival before and after.
const std::vector<Fault>& all_faults();

}  // namespace alight
