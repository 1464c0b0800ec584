#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "dataset/messages/message_types.hpp"

namespace alight {

/// Puts the two eyes of one exposure together. Each eye's images must come in time order; the two streams may
/// be shifted against each other by any number of messages.
class StereoPairer {
 public:
  explicit StereoPairer(std::int64_t tolerance_ns) : tolerance_ns_(tolerance_ns) {}

  /// @returns the frame that this image completes; its time is the left image's
  std::optional<StereoFrame> add_left(CameraImage image);
  std::optional<StereoFrame> add_right(CameraImage image);

  /// Images that had no partner, without those that still wait for one.
  std::int64_t unpaired() const { return unpaired_; }
  /// Images that wait for a partner.
  std::int64_t waiting() const { return static_cast<std::int64_t>(left_.size() + right_.size()); }

 private:
  std::optional<StereoFrame> match();
  void add(std::deque<CameraImage>& queue, CameraImage image);

  std::int64_t tolerance_ns_;
  std::int64_t unpaired_ = 0;
  std::deque<CameraImage> left_;
  std::deque<CameraImage> right_;
};

}  // namespace alight
