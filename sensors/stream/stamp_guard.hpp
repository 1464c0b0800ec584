#pragma once

#include <cstdint>
#include <optional>

namespace alight {

/// Tells the stamps of one topic that cannot be true from the others, by the times at which its messages were received.
/// A stamp jumps if it is earlier than the one before or much later, and the time of receipt does not say the same. (A
/// recorder that stalls delays the receipt of many messages, but their stamps stay regular; a sensor that pauses leaves the
/// same gap in both.) Where the messages agree on a jump, the clock was set: from then on they are taken again.
class StampGuard {
 public:
  static constexpr std::int64_t kMaxJump_ns = 500'000'000;
  static constexpr int kAgreeing = 5;  ///< messages in a row that make a jump a clock that was set

  /// False: the stamp jumps; the message is of no use.
  bool usable(std::int64_t stamp_ns, std::int64_t receive_ns);

 private:
  struct Times {
    std::int64_t stamp_ns = 0;
    std::int64_t receive_ns = 0;
  };
  static bool follows(const Times& before, const Times& now);

  std::optional<Times> last_;  // of the messages that were usable
  std::optional<Times> last_jump_;
  int agreeing_ = 0;
};

}  // namespace alight
