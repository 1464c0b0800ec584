#include "dataset/inspect/sample_picture.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "geometry/depth_map.hpp"

namespace alight {
namespace {

constexpr int kScale = 2;  // a LiDAR point is one pixel: too small to see
constexpr int kLabelHeight_px = 26;
constexpr int kBorder_px = 6;

cv::Mat enlarged(const cv::Mat& image) {
  cv::Mat big;
  cv::resize(image, big, {}, kScale, kScale, cv::INTER_NEAREST);
  return big;
}

cv::Mat to_bgr(const cv::Mat& image) {
  if (image.channels() == 3) return image;
  cv::Mat bgr;
  cv::cvtColor(image, bgr, cv::COLOR_GRAY2BGR);
  return bgr;
}

cv::Mat over_image(const cv::Mat& image, const cv::Mat& colours, const cv::Mat& known) {
  cv::Mat panel = to_bgr(image) * 0.5;
  colours.copyTo(panel, known);
  return panel;
}

/// Blue = before the image, red = after it, white = with it.
cv::Mat colour_offsets(const SparseDepth& sparse, double limit_s) {
  cv::Mat colours = cv::Mat::zeros(sparse.depth_m.size(), CV_8UC3);
  for (int v = 0; v < colours.rows; ++v) {
    for (int u = 0; u < colours.cols; ++u) {
      const double share = std::clamp(sparse.offset_us.at<std::int32_t>(v, u) * 1e-6 / limit_s, -1.0, 1.0);
      const auto fade = cv::saturate_cast<std::uint8_t>(255 * (1 - std::abs(share)));
      colours.at<cv::Vec3b>(v, u) = share < 0 ? cv::Vec3b(255, fade, fade) : cv::Vec3b(fade, fade, 255);
    }
  }
  return colours;
}

cv::Mat labelled(const cv::Mat& panel, const std::string& label) {
  cv::Mat out;
  cv::copyMakeBorder(enlarged(panel), out, kLabelHeight_px, kBorder_px, kBorder_px, kBorder_px,
                     cv::BORDER_CONSTANT, cv::Scalar::all(24));
  cv::putText(out, label, {kBorder_px, kLabelHeight_px - 8}, cv::FONT_HERSHEY_SIMPLEX, 0.5,
              cv::Scalar::all(240), 1, cv::LINE_AA);
  return out;
}

}  // namespace

cv::Mat draw_sample(const Sample& sample, const std::string& title) {
  const cv::Mat known = sample.sparse.depth_m > 0;
  const ColourRange depth = colour_range(sample.dense_m.empty() ? sample.sparse.depth_m : sample.dense_m);
  double min_us = 0;
  double max_us = 0;
  cv::minMaxLoc(sample.sparse.offset_us, &min_us, &max_us);
  const double limit_s = std::max({1e-3, -min_us * 1e-6, max_us * 1e-6});

  const std::string scale = fmt::format("{:.1f} m red .. {:.1f} m blue", depth.min_m, depth.max_m);
  std::vector<cv::Mat> panels = {
      labelled(to_bgr(sample.left), title),
      labelled(over_image(sample.left, colour_depth(sample.sparse.depth_m, depth.min_m, depth.max_m), known),
               fmt::format("sparse depth, {} pixels, ", cv::countNonZero(known)) + scale),
      labelled(over_image(sample.left, colour_offsets(sample.sparse, limit_s), known),
               fmt::format("time offset, {:.2f} s before (blue) .. {:.2f} s after (red)", -min_us * 1e-6,
                           max_us * 1e-6))};
  if (!sample.dense_m.empty()) {
    panels.push_back(
        labelled(colour_depth(sample.dense_m, depth.min_m, depth.max_m), "true depth, " + scale));
  }
  cv::Mat picture;
  cv::hconcat(panels, picture);
  return picture;
}

}  // namespace alight
