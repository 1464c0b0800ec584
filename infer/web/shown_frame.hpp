#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "infer/depth/landing_pipeline.hpp"
#include "infer/onboard/steady_time.hpp"

namespace alight {

/// The pictures of a frame, as overlay.hpp draws them.
enum class Picture { kLeft, kDepth, kSafe };
/// "left", "depth", "safe"; empty for another name
std::optional<Picture> picture_named(const std::string& name);

/// How frames are shown.
struct FrameStyle {
  cv::Rect crop;           ///< of the results' images in the rectified left image
  int confirm_frames = 5;  ///< SiteTrackerConfig::confirm_frames
  int jpeg_quality = 80;
};

/// One result on its way to the viewers. Pictures and text are made when the first viewer asks and kept for the others;
/// any thread may ask.
class ShownFrame {
 public:
  /// @param number counts results from 1
  ShownFrame(std::int64_t number, SteadyTime received, std::shared_ptr<const FrameReport> report,
             const FrameStyle& style);

  std::int64_t number() const { return number_; }
  SteadyTime received() const { return received_; }
  /// The frame's part of the state, see docs/ground_station.md.
  const std::string& json() const;
  /// JPEG of the crop's size.
  const std::string& jpeg(Picture picture) const;

 private:
  struct Lazy {
    std::once_flag once;
    std::string bytes;
  };

  std::int64_t number_;
  SteadyTime received_;
  std::shared_ptr<const FrameReport> report_;
  FrameStyle style_;
  mutable Lazy json_;
  mutable std::array<Lazy, 3> jpegs_;
};

}  // namespace alight
