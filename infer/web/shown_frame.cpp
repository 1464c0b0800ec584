#include "infer/web/shown_frame.hpp"

#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "foundation/errors.hpp"
#include "infer/replay/overlay.hpp"
#include "infer/web/state_json.hpp"

namespace alight {
namespace {

cv::Mat draw(const FrameReport& report, Picture picture) {
  switch (picture) {
    case Picture::kLeft:
      break;
    case Picture::kDepth:
      return depth_picture(report);
    case Picture::kSafe:
      return safe_picture(report);
  }
  return site_picture(report);
}

/// An image that was given up before it was opened is drawn as a black one.
cv::Mat draw(const FrameReport& report, Picture picture, cv::Size size) {
  if (!report.depth.left.empty()) return draw(report, picture);
  FrameReport black = report;
  black.depth.left = cv::Mat::zeros(size, CV_8UC3);
  return draw(black, picture);
}

std::string encode(const cv::Mat& picture, int quality) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, quality}))
    throw DataError("ground station: OpenCV cannot encode JPEG");
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::optional<Picture> picture_named(const std::string& name) {
  if (name == "left") return Picture::kLeft;
  if (name == "depth") return Picture::kDepth;
  if (name == "safe") return Picture::kSafe;
  return std::nullopt;
}

ShownFrame::ShownFrame(std::int64_t number, SteadyTime received, std::shared_ptr<const FrameReport> report,
                       const FrameStyle& style)
    : number_(number), received_(received), report_(std::move(report)), style_(style) {}

const std::string& ShownFrame::json() const {
  std::call_once(json_.once, [this] { json_.bytes = frame_json(*report_, style_); });
  return json_.bytes;
}

const std::string& ShownFrame::jpeg(Picture picture) const {
  Lazy& lazy = jpegs_[static_cast<std::size_t>(picture)];
  std::call_once(lazy.once, [&] {
    lazy.bytes = encode(draw(*report_, picture, style_.crop.size()), style_.jpeg_quality);
  });
  return lazy.bytes;
}

}  // namespace alight
