#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "sensors/messages/message_types.hpp"

namespace alight::sim {

/// A message and when it came.
struct TimedMessage {
  std::int64_t receive_ns = 0;
  LogMessage message;
};
using Messages = std::vector<TimedMessage>;

/// Sees every message of a flight in the order in which they would arrive, healthy ones before the fault included, and
/// may change it or when it comes. @returns false to lose it
using FaultFilter = std::function<bool(TimedMessage&)>;

/// What can break, and how it has to be noticed.
struct Fault {
  std::string name;    ///< for people
  std::string sensor;  ///< of the finding; empty: nothing can be found
  std::string finding;
  std::string state;  ///< "degraded" or "failed" with a network; empty: nothing can be found
  /// A sensor that breaks at `from_ns` (receive time) and stays broken. Filters of one fault are independent.
  std::function<FaultFilter(std::int64_t from_ns)> begin;
};

/// A fault that is over with the messages that would arrive at `until_ns` or later.
FaultFilter passing(FaultFilter fault, std::int64_t until_ns);

/// Every fault.
const std::vector<Fault>& all_faults();
/// Null if there is none of that name.
const Fault* find_fault(const std::string& name);

/// A whole healthy flight, in order of arrival, with a fault from `from_ns` on; in order of arrival again.
Messages inject(const Fault& fault, const Messages& flight, std::int64_t from_ns);

}  // namespace alight::sim
