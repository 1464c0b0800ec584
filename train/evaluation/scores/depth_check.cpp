#include "train/evaluation/scores/depth_check.hpp"

#include <fmt/format.h>

#include "geometry/crop.hpp"
#include "geometry/frames.hpp"
#include "geometry/projection.hpp"
#include "geometry/rig/stereo_rectification.hpp"

namespace alight {
namespace {

std::string pixels_of(cv::Size size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

RectifiedRig rig_of_images(const Rig& rig, cv::Size size, bool centre_cropped) {
  if (!rig.cam1)
    throw ConfigError("the rig has no cam1: without a right camera there is no stereo test; add it");
  const RectifiedRig whole = StereoRectifier(rig).rig();
  const cv::Size expected = whole.intrinsics.size();
  if (size == expected) return whole;
  if (centre_cropped && size.width <= expected.width && size.height <= expected.height) {
    return crop(whole, centre_crop(expected, size));
  }
  throw DataError(
      "the left image has " + pixels_of(size) + " pixels, the rig's cameras have " + pixels_of(expected) +
      "; give the rig of these images, or --centre-cropped if they are the centres of larger ones");
}

void check_sizes(const DepthCheckInput& input) {
  const auto check = [&](const cv::Mat& map, const char* what) {
    if (map.empty() || map.size() == input.left.size()) return;
    throw DataError(std::string("the ") + what + " has " + pixels_of(map.size()) +
                    " pixels, the left image " + pixels_of(input.left.size()) + "; all must have one size");
  };
  check(input.right, "right image");
  check(input.depth_m, "depth map");
  check(input.sparse_m, "sparse depth map");
  check(input.truth_m, "true depth map");
}

/// Where the LiDAR sees, at the mean of the depths; everywhere for a rig that says nothing about a LiDAR.
cv::Mat lidar_fov(const cv::Mat& sparse_m, const RectifiedRig& rig, bool has_lidar, double half_fov_deg) {
  if (!has_lidar) return cv::Mat(sparse_m.size(), CV_8UC1, cv::Scalar(255));
  const double depth_m = cv::mean(sparse_m, sparse_m > 0)[0];
  return lidar_fov_mask(rig.intrinsics, rig.T_camera_lidar, to_radians(half_fov_deg), depth_m);
}

std::string score_line(const char* name, const std::optional<double>& value, const char* meaning) {
  return value ? fmt::format("{:10} {:.4f}  {}\n", name, *value, meaning)
               : fmt::format("{:10} -       {}\n", name, meaning);
}

}  // namespace

DepthCheckResult check_depth(const DepthCheckInput& input, const Rig& rig, const DepthCheckConfig& config) {
  check_sizes(input);
  const RectifiedRig images = rig_of_images(rig, input.left.size(), config.centre_cropped);
  const StereoTest test(input.left, input.right, images);
  const RightView prediction = test.reconstruct(input.depth_m);
  std::optional<RightView> lidar;
  if (!input.sparse_m.empty() && cv::countNonZero(input.sparse_m) > 0) {
    const cv::Mat fov = lidar_fov(input.sparse_m, images, rig.lidar0.has_value(), config.lidar_half_fov_deg);
    lidar = test.reconstruct(interpolate_inside_fov(input.sparse_m, fov, config.interpolation));
  }
  DepthCheckResult result;
  result.scores = test.score(prediction, lidar ? &*lidar : nullptr);
  result.paper_accepts = paper_accepts(result.scores, config.stereo);
  if (config.stereo.probe > 0 && result.paper_accepts) {
    result.scores.peak = test.peak(input.depth_m, prediction, config.stereo.probe);
  }
  result.verdict = judge(result.scores, config.stereo);
  if (!input.truth_m.empty()) result.errors = measure(input.depth_m, {}, input.truth_m, {});
  return result;
}

std::string format_check(const DepthCheckResult& result) {
  const StereoScores& scores = result.scores;
  std::string text = score_line("sim", scores.sim, "left image as it is, against the right one");
  text += score_line("sim_d", scores.sim_d, "left image moved by the LiDAR depth");
  text += score_line("sim_pred", scores.sim_pred, "left image moved by the depth map");
  text += score_line("share", scores.share, "of the image compared");
  text += score_line("peak", scores.peak, "sim_pred above that of nearer and farther depth");
  text += fmt::format("{:10} {}\n", "paper", result.paper_accepts ? "accept" : "reject");
  text += fmt::format("{:10} {}\n", "verdict", name(result.verdict));
  if (!result.errors) return text;
  for (const Metric metric : kMetrics)
    text += fmt::format("{:18} {:.2f}\n", title(metric), result.errors->value(metric));
  text += fmt::format("{:18} {}, {} more have no depth\n", "pixels compared", result.errors->pixels(),
                      result.errors->unknown());
  return text;
}

}  // namespace alight
