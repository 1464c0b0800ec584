#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace alight {

struct Decoder;

/// An image of one camera as it came, not decoded yet.
struct UndecodedImage {
  std::int64_t t_ns = 0;
  const Decoder* decoder = nullptr;
  std::vector<std::uint8_t> bytes;
  std::int64_t receive_ns = 0;
};

/// Both cameras of one exposure, not decoded yet; without `right` of a mono rig.
struct UndecodedFrame {
  UndecodedImage left;
  std::optional<UndecodedImage> right;
};

/// Puts the two cameras of one exposure together, before anything is decoded. Each camera's images must come in time order; the
/// two streams may be shifted against each other by any number of messages.
class StereoPairer {
 public:
  using Pair = std::pair<UndecodedImage, UndecodedImage>;  ///< left, right

  explicit StereoPairer(std::int64_t tolerance_ns) : tolerance_ns_(tolerance_ns) {}

  /// @returns the pair that this image completes
  std::optional<Pair> add_left(UndecodedImage image);
  std::optional<Pair> add_right(UndecodedImage image);

  /// Images that had no partner, without those that still wait for one.
  std::int64_t unpaired() const { return unpaired_; }
  /// Images that wait for a partner.
  /// By how much the right stamps are after the left ones, where that is always the same and too much for any pair.
  std::optional<std::int64_t> constant_lead_ns() const;
  std::int64_t waiting() const { return static_cast<std::int64_t>(left_.size() + right_.size()); }

 private:
  std::optional<Pair> match();
  void add(std::deque<UndecodedImage>& queue, UndecodedImage image);

  std::int64_t tolerance_ns_;
  std::int64_t unpaired_ = 0;
  bool paired_ = false;                           // at least once
  std::deque<std::int64_t> right_after_left_ns_;  // of the latest that were no pair
  std::deque<UndecodedImage> left_;
  std::deque<UndecodedImage> right_;
};

}  // namespace alight
