#include "infer/health/camera_alignment.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "geometry/crop.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr double kLeastContrast = 2;  // grey levels, 1 sigma
/// A shift that leaves no less than this share of the difference that the right place leaves explains nothing better.
constexpr double kClearlyMoreAlike = 0.5;
constexpr double kSamePixel_px = 0.5;   // a shift below it is that of what moves with the cameras
constexpr double kSamePicture = 0.999;  // likeness: one picture under two names

double contrast(const cv::Mat& grey) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(grey, mean, deviation);
  return deviation[0];
}

cv::Mat grey_middle(const cv::Mat& image, int side_px) {
  const cv::Mat middle = image(centre_crop(image.size(), {side_px, side_px}));
  cv::Mat grey = middle;
  if (middle.channels() == 3) cv::cvtColor(middle, grey, cv::COLOR_BGR2GRAY);
  cv::Mat real;
  grey.convertTo(real, CV_32FC1);
  return real;
}

}  // namespace

StereoShift stereo_shift(const cv::Mat& left, const cv::Mat& right, int window_px) {
  const int side_px = std::min({window_px, left.cols, left.rows});
  const cv::Mat middle_left = grey_middle(left, side_px);
  const cv::Mat middle_right = grey_middle(right, side_px);
  StereoShift shift;
  if (std::min(contrast(middle_left), contrast(middle_right)) < kLeastContrast) return shift;
  cv::Mat window;
  cv::createHanningWindow(window, {side_px, side_px}, CV_32FC1);
  shift.shift_px = cv::phaseCorrelate(middle_left, middle_right, window, &shift.response);
  return shift;
}

double likeness(const cv::Mat& left, const cv::Mat& right, const cv::Point2d& shift_px, int window_px) {
  const int side_px = std::min({window_px, left.cols, left.rows});
  const cv::Mat a = grey_middle(left, side_px);
  cv::Mat b;
  const cv::Matx23d move(1, 0, shift_px.x, 0, 1, shift_px.y);
  cv::warpAffine(grey_middle(right, side_px), b, move, a.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  const int border_px = 1 + static_cast<int>(std::ceil(std::max(std::abs(shift_px.x), std::abs(shift_px.y))));
  const int inner_px = side_px - 2 * border_px;
  if (inner_px < side_px / 2) return 0;
  const cv::Rect inner(border_px, border_px, inner_px, inner_px);
  cv::Mat result;
  cv::matchTemplate(a(inner), b(inner), result, cv::TM_CCOEFF_NORMED);
  return static_cast<double>(result.at<float>(0, 0));
}

CameraAlignment::CameraAlignment(const HealthConfig& config, const RectifiedRig& rig)
    : config_(config),
      focal_baseline_px_m_(rig.intrinsics.fx_px * rig.baseline_m),
      swapped_("stereo", "cameras swapped"),
      misaligned_("stereo", "cameras misaligned") {}

bool CameraAlignment::due(std::int64_t t_ns) const {
  return suspected() || !last_ns_ || to_seconds(t_ns - *last_ns_) >= config_.stereo.period_s;
}

void CameraAlignment::add(std::int64_t t_ns, const cv::Mat& left, const cv::Mat& right,
                          std::optional<double> distance_m) {
  last_ns_ = t_ns;
  if (!distance_m || *distance_m <= 0) return;
  const StereoShift measured = stereo_shift(left, right, config_.stereo.window_px);
  if (measured.response < config_.stereo.min_response) return;
  const double disparity_px = focal_baseline_px_m_ / *distance_m;
  const cv::Point2d& shift_px = measured.shift_px;
  const double off_px = std::hypot(shift_px.x + disparity_px, shift_px.y);
  const double off_swapped_px = std::hypot(shift_px.x - disparity_px, shift_px.y);
  const double limit_px = config_.stereo.max_misalignment_px;
  const bool swapped = disparity_px >= config_.stereo.min_disparity_px && off_swapped_px < disparity_px / 2;
  const std::string text =
      fmt::format("right image shifted by ({:.2f}, {:.2f}) px, ({:.2f}, 0) px expected at {:.1f} m",
                  shift_px.x, shift_px.y, -disparity_px, *distance_m);
  const auto alike = [&](const cv::Point2d& shift) {
    return likeness(left, right, shift, config_.stereo.window_px);
  };
  if (swapped || off_px > limit_px) {
    const double measured_alike = alike(shift_px);
    const double due_alike = alike({-disparity_px, 0});
    const bool moves_with_the_cameras = cv::norm(shift_px) < kSamePixel_px && measured_alike < kSamePicture;
    if (moves_with_the_cameras || 1 - measured_alike > kClearlyMoreAlike * (1 - due_alike)) return;
  }
  swapped_.look(config_, t_ns, swapped, text);
  misaligned_.look(config_, t_ns, !swapped && off_px > limit_px, text);
}

void CameraAlignment::report(std::vector<HealthFinding>& findings) const {
  swapped_.report(findings);
  misaligned_.report(findings);
}

}  // namespace alight
