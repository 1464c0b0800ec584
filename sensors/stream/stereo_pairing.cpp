#include "sensors/stream/stereo_pairing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace alight {
namespace {

/// Two seconds at 20 Hz: where one camera died the other's images must not fill the memory.
constexpr std::size_t kMaxWaiting = 40;
constexpr std::size_t kJudged = 20;               ///< misses that tell a constant difference
constexpr std::int64_t kSameLead_ns = 2'000'000;  ///< stamps jitter

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
      paired_ = true;
      return pair;
    }
    right_after_left_ns_.push_back(right_after_left_ns);
    if (right_after_left_ns_.size() > kJudged) right_after_left_ns_.pop_front();
    // The later image's stream has passed the earlier one by: nothing can pair with it any more.
    (right_after_left_ns > 0 ? left_ : right_).pop_front();
    ++unpaired_;
  }
  return std::nullopt;
}

std::optional<std::int64_t> StereoPairer::constant_lead_ns() const {
  if (paired_ || right_after_left_ns_.size() < kJudged) return std::nullopt;
  // Each image is held against the other camera's before and after it; the nearer one is of its exposure.
  std::vector<std::int64_t> nearest(right_after_left_ns_.begin(), right_after_left_ns_.end());
  std::sort(nearest.begin(), nearest.end(),
            [](std::int64_t a, std::int64_t b) { return std::abs(a) < std::abs(b); });
  nearest.resize(kJudged / 2);
  const auto [least, most] = std::minmax_element(nearest.begin(), nearest.end());
  if (*most - *least > kSameLead_ns) return std::nullopt;
  return nearest[nearest.size() / 2];
}

}  // namespace alight
