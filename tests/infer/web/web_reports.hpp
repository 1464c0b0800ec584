#pragma once

#include <opencv2/core.hpp>

#include "infer/depth/landing_pipeline.hpp"

/// Results as the pipeline makes them, with known content: 64x48.
namespace alight::reports {

constexpr int kWidth_px = 64;
constexpr int kHeight_px = 48;
inline cv::Rect crop() { return {10, 20, kWidth_px, kHeight_px}; }

/// Depth of 20 m: predicted on the left half, interpolated on a quarter, unknown on the rest.
inline FrameReport with_depth(std::int64_t t_ns) {
  FrameReport report;
  DepthResult& depth = report.depth;
  depth.t_ns = t_ns;
  depth.source = DepthSource::kLidar;
  depth.reason = "trusted";
  depth.accumulation_s = 0.3;
  depth.predictions = 2;
  depth.stereo = {0.4, 0.8, 0.7, 0.9, 0.05};
  depth.holdout = {500, 0.02, 0.05, 0.001, 0.0025};
  depth.left = cv::Mat(kHeight_px, kWidth_px, CV_8UC3, cv::Scalar(90, 120, 60));
  depth.depth_m = cv::Mat(kHeight_px, kWidth_px, CV_32FC1, cv::Scalar(20));
  depth.pixel_source = cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(1));
  depth.pixel_source.colRange(32, 48).setTo(2);
  depth.pixel_source.colRange(48, 64).setTo(0);
  depth.depth_m.colRange(48, 64).setTo(0);
  report.selection.emplace();
  report.selection->status = SiteStatus::kNoFlatArea;
  report.selection->safe = cv::Mat::zeros(kHeight_px, kWidth_px, CV_8UC1);
  report.selection->terrain.known = cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(255));
  return report;
}

/// The same with a site that `frames` frames have found.
inline FrameReport with_site(std::int64_t t_ns, int frames, bool accepted) {
  FrameReport report = with_depth(t_ns);
  report.selection->status = SiteStatus::kFound;
  report.decision.site.emplace();
  report.decision.site->frames = frames;
  report.decision.site->accepted = accepted;
  report.decision.site->circle.radius_m = 3;
  report.decision.site->circle.radius_px = 12;
  report.decision.site->circle.depth_m = 20;
  report.decision.site->circle.centre_px = {30, 20};
  report.selection->largest = report.decision.site->circle;
  report.image_site = ImageSite{30, 20, 12};
  return report;
}

/// An image that was given up before it was opened.
inline FrameReport without_depth(std::int64_t t_ns) {
  FrameReport report;
  report.depth.t_ns = t_ns;
  report.depth.reason = "no pose";
  report.health.state = HealthState::kDegraded;
  report.health.findings.push_back({"lidar", "lost", "no packet for 2.0 s", t_ns - 2'000'000'000});
  return report;
}

}  // namespace alight::reports
