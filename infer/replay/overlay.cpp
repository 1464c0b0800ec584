#include "infer/replay/overlay.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "geometry/depth_map.hpp"

namespace alight {
namespace {

constexpr int kTitle_px = 24;
constexpr int kGap_px = 4;
const cv::Scalar kGreen(80, 220, 80);
const cv::Scalar kOrange(40, 160, 255);
const cv::Scalar kWhite(255, 255, 255);

cv::Mat in_colour(const cv::Mat& image) {
  cv::Mat bgr;
  if (image.channels() == 1) {
    cv::cvtColor(image, bgr, cv::COLOR_GRAY2BGR);
  } else {
    bgr = image.clone();
  }
  return bgr;
}

void write(cv::Mat& image, const std::string& text, cv::Point at, const cv::Scalar& colour) {
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.42, cv::Scalar::all(0), 3, cv::LINE_AA);
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, 0.42, colour, 1, cv::LINE_AA);
}

cv::Mat black_with(cv::Size size, const std::string& text) {
  cv::Mat image = cv::Mat::zeros(size, CV_8UC3);
  write(image, text, {8, size.height / 2}, kWhite);
  return image;
}

/// Dark diagonal stripes over the pixels of `mask`.
void hatch(cv::Mat& image, const cv::Mat& mask) {
  constexpr int kPeriod_px = 8;
  constexpr int kStripe_px = 3;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      if (mask.at<std::uint8_t>(v, u) != 0 && (u + v) % kPeriod_px < kStripe_px)
        image.at<cv::Vec3b>(v, u) = image.at<cv::Vec3b>(v, u) * 0.45;
    }
  }
}

/// Green once the site counts, orange before.
const cv::Scalar& colour_of(const TrackedSite& site) { return site.accepted ? kGreen : kOrange; }

void draw_circle(cv::Mat& image, double u_px, double v_px, double radius_px, const cv::Scalar& colour) {
  const cv::Point centre(static_cast<int>(std::lround(u_px)), static_cast<int>(std::lround(v_px)));
  cv::circle(image, centre, static_cast<int>(std::lround(radius_px)), colour, 2, cv::LINE_AA);
  cv::drawMarker(image, centre, colour, cv::MARKER_CROSS, 14, 2, cv::LINE_AA);
}

Panel depth_panel(const FrameReport& frame) {
  const DepthResult& depth = frame.depth;
  if (depth.depth_m.empty()) return {"depth: none", depth_picture(frame)};
  const ColourScale scale = colour_scale(depth.depth_m);
  const std::string title = fmt::format("depth: {}, {:.1f} s LiDAR, {:.1f}-{:.1f} m", name(depth.source),
                                        depth.accumulation_s, scale.min_m, scale.max_m);
  return {title, depth_picture(frame)};
}

Panel sparse_panel(const FrameReport& frame) {
  cv::Mat thick;  // single pixels vanish in a README
  cv::dilate(frame.depth.sparse_m, thick, cv::Mat::ones(2, 2, CV_8UC1));
  const ColourScale scale = colour_scale(frame.depth.depth_m.empty() ? thick : frame.depth.depth_m);
  const std::string title = fmt::format("LiDAR: {} points, {:.1f} s", cv::countNonZero(frame.depth.sparse_m),
                                        frame.depth.accumulation_s);
  return {title, colour_depth(thick, scale.min_m, scale.max_m)};
}

Panel safe_panel(const FrameReport& frame) {
  return {frame.selection ? "safe ground, seen level (green)" : "safe ground", safe_picture(frame)};
}

Panel site_panel(const FrameReport& frame) {
  cv::Mat image = site_picture(frame);
  if (!frame.image_site) {
    write(image, frame.selection ? describe(*frame.selection) : "no trusted depth", {8, 20}, kOrange);
    return {"landing site: none", image};
  }
  const TrackedSite& tracked = *frame.decision.site;
  const std::string text = fmt::format("R = {:.1f} m, {} frames", tracked.circle.radius_m, tracked.frames);
  write(image, text, {8, 20}, colour_of(tracked));
  return {tracked.accepted ? "landing site: accepted" : "landing site: not yet confirmed", image};
}

Panel image_panel(const FrameReport& frame) { return {"left image", in_colour(frame.depth.left)}; }

}  // namespace

ColourScale colour_scale(const cv::Mat& depth_m) {
  ColourScale scale;
  const cv::Mat known = depth_m > 0;
  if (cv::countNonZero(known) == 0) return scale;
  cv::minMaxLoc(depth_m, &scale.min_m, &scale.max_m, nullptr, nullptr, known);
  scale.max_m = std::max(scale.max_m, scale.min_m + 0.1);
  return scale;
}

cv::Mat site_picture(const FrameReport& frame) {
  cv::Mat image = in_colour(frame.depth.left);
  if (frame.image_site && frame.decision.site) {
    const ImageSite& site = *frame.image_site;
    draw_circle(image, site.u_px, site.v_px, site.radius_px, colour_of(*frame.decision.site));
  }
  return image;
}

cv::Mat depth_picture(const FrameReport& frame) {
  const DepthResult& depth = frame.depth;
  if (depth.depth_m.empty()) return black_with(depth.left.size(), "no trusted depth");
  const ColourScale scale = colour_scale(depth.depth_m);
  cv::Mat image = colour_depth(depth.depth_m, scale.min_m, scale.max_m);
  hatch(image, depth.pixel_source == static_cast<int>(PixelSource::kInterpolated));
  return image;
}

cv::Mat safe_picture(const FrameReport& frame) {
  if (!frame.selection) return black_with(frame.depth.left.size(), "no trusted depth");
  const SiteSelection& selection = *frame.selection;
  cv::Mat image(selection.safe.size(), CV_8UC3, cv::Scalar(40, 40, 40));
  image.setTo(cv::Scalar(60, 60, 200), selection.terrain.known);
  image.setTo(cv::Scalar(80, 170, 60), selection.safe);
  if (frame.decision.site) {
    const TrackedSite& site = *frame.decision.site;
    // The circle's own green would vanish on the green of safe ground.
    const cv::Scalar& colour = site.accepted ? kWhite : kOrange;
    draw_circle(image, site.circle.centre_px.x(), site.circle.centre_px.y(), site.circle.radius_px, colour);
  }
  return image;
}

cv::Mat panel_strip(const std::vector<Panel>& panels) {
  int width = -kGap_px;
  int height = 0;
  for (const Panel& panel : panels) {
    width += panel.image.cols + kGap_px;
    height = std::max(height, panel.image.rows);
  }
  cv::Mat strip(height + kTitle_px, std::max(width, 1), CV_8UC3, cv::Scalar::all(24));
  int x = 0;
  for (const Panel& panel : panels) {
    panel.image.copyTo(strip(cv::Rect({x, kTitle_px}, panel.image.size())));
    write(strip, panel.title, {x + 4, kTitle_px - 8}, kWhite);
    x += panel.image.cols + kGap_px;
  }
  return strip;
}

cv::Mat replay_strip(const FrameReport& frame) {
  return panel_strip({image_panel(frame), depth_panel(frame), safe_panel(frame), site_panel(frame)});
}

cv::Mat method_strip(const FrameReport& frame) {
  return panel_strip({image_panel(frame), sparse_panel(frame), depth_panel(frame), site_panel(frame)});
}

}  // namespace alight
