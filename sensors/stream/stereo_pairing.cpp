#include "sensors/stream/stereo_pairing.hpp"

#include <cmath>
#include <cstdlib>
#include <utility>

namespace alight {
namespace {

/// Two seconds at 20 Hz: where one camera died the other's images must not fill the memory.
constexpr std::size_t kMaxWaiting = 40;

}  // namespace

std::optional<StereoPairer::Pair> StereoPairer::add_left(UndecodedImage image) {
  add(left_, std::move(image));
  return match();
}

std::optional<StereoPairer::Pair> StereoPairer::add_right(UndecodedImage image) {
  add(right_, std::move(image));
  return match();
}

void StereoPairer::add(std::deque<UndecodedImage>& queue, UndecodedImage image) {
  queue.push_back(std::move(image));
  if (queue.size() <= kMaxWaiting) return;
  queue.pop_front();
  ++unpaired_;
}

std::optional<StereoPairer::Pair> StereoPairer::match() {
  while (!left_.empty() && !right_.empty()) {
    const std::int64_t right_after_left_ns = right_.front().t_ns - left_.front().t_ns;
    if (std::abs(right_after_left_ns) <= tolerance_ns_) {
      Pair pair{std::move(left_.front()), std::move(right_.front())};
      left_.pop_front();
      right_.pop_front();
      return pair;
    }
    // The later image's stream has passed the earlier one by: nothing can pair with it any more.
    (right_after_left_ns > 0 ? left_ : right_).pop_front();
    ++unpaired_;
  }
  return std::nullopt;
}

}  // namespace alight
