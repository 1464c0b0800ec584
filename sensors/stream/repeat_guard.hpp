#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "sensors/messages/byte_reader.hpp"

namespace alight {

/// Tells a message that was recorded twice (a merge of two bags, two recorders): the same bytes, stamp and all, as one of
/// the last ones of its topic. Points would count twice.
class RepeatGuard {
 public:
  /// @returns true if this message came before
  bool repeated(const RawMessage& message);

 private:
  std::deque<std::string> last_;  // content hashes
};

}  // namespace alight
