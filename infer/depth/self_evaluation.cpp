#include "infer/depth/self_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "foundation/config_reader.hpp"
#include "foundation/order_statistics.hpp"
#include "infer/depth/image_ssim.hpp"

namespace alight {
namespace {

/// Pixels whose 3x3 window is valid in both.
cv::Mat whole_windows(const cv::Mat& valid_a, const cv::Mat& valid_b) {
  cv::Mat valid;
  cv::bitwise_and(valid_a, valid_b, valid);
  cv::erode(valid, valid, cv::Mat::ones(3, 3, CV_8UC1));
  return valid;
}

}  // namespace

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kAccept:
      return "accept";
    case Verdict::kReject:
      return "reject";
    case Verdict::kNoEvidence:
      break;
  }
  return "no evidence";
}

void bind(Binder& b, StereoTestConfig& c) {
  b.field("min_gain", c.min_gain, "accept when sim_pred > sim + this", between(0, 2));
  b.field("min_contrast", c.min_contrast, "abstain when sim_d - sim is less; 0: the paper", between(0, 2));
  b.field("min_share", c.min_share, "abstain when a smaller share of the image is comparable", between(0, 1));
  b.field("probe", c.probe, "must beat itself moved nearer and farther by this share; 0: off, the paper",
          between(0, 1));
  b.field("min_peak", c.min_peak, "by so much similarity; abstain when the three differ less", between(0, 1));
}

void bind(Binder& b, HoldoutTestConfig& c) {
  b.field("max_median_relative", c.max_median_relative, "largest median of |error| / depth", between(0, 10));
  b.field("max_rms_relative", c.max_rms_relative, "largest RMS of error / depth", between(0, 10));
  b.field("min_points", c.min_points, "abstain with fewer held-out pixels", at_least(1));
}

void bind(Binder& b, SelfEvaluationConfig& c) {
  b.choice("decide_by", c.decide_by,
           {{"stereo", DecideBy::kStereo},
            {"lidar_holdout", DecideBy::kLidarHoldout},
            {"either", DecideBy::kEither},
            {"both", DecideBy::kBoth}},
           "which test decides; both are always logged");
  b.section("stereo", c.stereo, "right image reconstructed from the left one");
  b.section("holdout", c.holdout, "LiDAR points that were not fed");
}

bool paper_accepts(const StereoScores& scores, const StereoTestConfig& config) {
  if (!scores.sim || !scores.sim_pred) return false;
  return *scores.sim_pred > *scores.sim + config.min_gain ||
         (scores.sim_d && *scores.sim_pred > (*scores.sim + *scores.sim_d) / 2);
}

Verdict judge(const StereoScores& scores, const StereoTestConfig& config) {
  if (!scores.sim || !scores.sim_pred || scores.share < config.min_share) return Verdict::kNoEvidence;
  const bool gained = *scores.sim_pred > *scores.sim + config.min_gain;
  const bool contrast = !scores.sim_d || *scores.sim_d - *scores.sim >= config.min_contrast;
  if (!gained && !contrast) return Verdict::kNoEvidence;
  if (!paper_accepts(scores, config)) return Verdict::kReject;
  if (!scores.peak || *scores.peak >= config.min_peak) return Verdict::kAccept;
  return *scores.peak <= -config.min_peak ? Verdict::kReject : Verdict::kNoEvidence;
}

StereoTest::StereoTest(const cv::Mat& left, const cv::Mat& right, const RectifiedRig& rig)
    : rig_(rig), left_(to_luminance(left)) {
  if (right.empty() || rig.baseline_m <= 0) return;
  right_ = to_luminance(right);
  ssim_plain_ = ssim_map(left_, right_);
}

/// Rectified cameras differ by a disparity along the row, so a row at a time is all there is to do: its surfaces go to the
/// right camera, the nearest wins, and there each looks up its luminance in the left image.
RightView StereoTest::reconstruct(const cv::Mat& depth_m) const {
  const auto focal_baseline_px_m = static_cast<float>(rig_.intrinsics.fx_px * rig_.baseline_m);
  const int width = depth_m.cols;
  cv::Mat luminance = cv::Mat::zeros(depth_m.size(), CV_32FC1);
  RightView view{{}, cv::Mat::zeros(depth_m.size(), CV_8UC1)};
  std::vector<float> nearest_m(static_cast<std::size_t>(width));
  for (int v = 0; v < depth_m.rows; ++v) {
    const float* depth_row_m = depth_m.ptr<float>(v);
    std::fill(nearest_m.begin(), nearest_m.end(), 0.0F);
    for (int u = 0; u < width; ++u) {
      const float z_m = depth_row_m[u];
      if (!(z_m > 0)) continue;
      const float u_right = static_cast<float>(u) - focal_baseline_px_m / z_m + 0.5F;
      if (!(u_right >= 0)) continue;
      float& held_m = nearest_m[static_cast<std::size_t>(u_right)];
      if (held_m == 0.0F || z_m < held_m) held_m = z_m;
    }
    const float* left_row = left_.ptr<float>(v);
    auto* luminance_row = luminance.ptr<float>(v);
    auto* valid_row = view.valid.ptr<std::uint8_t>(v);
    for (int u = 0; u < width; ++u) {
      const float z_m = nearest_m[static_cast<std::size_t>(u)];
      if (z_m == 0.0F) continue;
      const float u_left = static_cast<float>(u) + focal_baseline_px_m / z_m;
      if (u_left > static_cast<float>(width - 1)) continue;
      const int below = std::min(static_cast<int>(u_left), width - 2);
      const float share = u_left - static_cast<float>(below);
      luminance_row[u] = (1 - share) * left_row[below] + share * left_row[below + 1];
      valid_row[u] = 255;
    }
  }
  if (has_right()) view.similarity = ssim_map(luminance, right_);
  return view;
}

StereoScores StereoTest::score(const RightView& prediction, const RightView* lidar) const {
  StereoScores scores;
  if (!has_right()) return scores;
  const cv::Mat counted = whole_windows(prediction.valid, lidar != nullptr ? lidar->valid : prediction.valid);
  const int pixels = cv::countNonZero(counted);
  if (pixels == 0) return scores;
  scores.share = static_cast<double>(pixels) / static_cast<double>(counted.total());
  scores.sim = cv::mean(ssim_plain_, counted)[0];
  scores.sim_pred = cv::mean(prediction.similarity, counted)[0];
  if (lidar != nullptr) scores.sim_d = cv::mean(lidar->similarity, counted)[0];
  return scores;
}

std::optional<double> StereoTest::peak(const cv::Mat& depth_m, const RightView& prediction,
                                       double probe) const {
  if (!has_right()) return std::nullopt;
  const RightView nearer = reconstruct(depth_m / (1 + probe));
  const RightView farther = reconstruct(depth_m * (1 + probe));
  const cv::Mat counted = whole_windows(whole_windows(nearer.valid, farther.valid), prediction.valid);
  if (cv::countNonZero(counted) == 0) return std::nullopt;
  const auto similarity = [&](const RightView& view) { return cv::mean(view.similarity, counted)[0]; };
  return similarity(prediction) - std::max(similarity(nearer), similarity(farther));
}

HoldoutScores compare_with_holdout(const cv::Mat& prediction_m, const cv::Mat& holdout_m,
                                   const cv::Mat& fed_m) {
  std::vector<double> errors_m;
  std::vector<double> relative;
  double squares = 0;
  double relative_squares = 0;
  for (int v = 0; v < holdout_m.rows; ++v) {
    for (int u = 0; u < holdout_m.cols; ++u) {
      const double truth_m = static_cast<double>(holdout_m.at<float>(v, u));
      if (!(truth_m > 0) || fed_m.at<float>(v, u) > 0) continue;
      const double predicted_m = static_cast<double>(prediction_m.at<float>(v, u));
      const double error_m = std::isfinite(predicted_m) ? std::abs(predicted_m - truth_m) : truth_m;
      errors_m.push_back(error_m);
      relative.push_back(error_m / truth_m);
      squares += error_m * error_m;
      relative_squares += relative.back() * relative.back();
    }
  }
  HoldoutScores scores;
  scores.points = static_cast<int>(errors_m.size());
  if (errors_m.empty()) return scores;
  scores.median_m = median(errors_m);
  scores.median_relative = median(relative);
  scores.rms_m = std::sqrt(squares / scores.points);
  scores.rms_relative = std::sqrt(relative_squares / scores.points);
  return scores;
}

Verdict judge(const HoldoutScores& scores, const HoldoutTestConfig& config) {
  if (scores.points < config.min_points) return Verdict::kNoEvidence;
  const bool good =
      scores.median_relative <= config.max_median_relative && scores.rms_relative <= config.max_rms_relative;
  return good ? Verdict::kAccept : Verdict::kReject;
}

Verdict decide(Verdict stereo, Verdict holdout, bool lidar_silent, DecideBy decide_by) {
  const bool one_accepts = stereo == Verdict::kAccept || holdout == Verdict::kAccept;
  const bool one_rejects = stereo == Verdict::kReject || holdout == Verdict::kReject;
  const bool holdout_missing = holdout == Verdict::kNoEvidence && !lidar_silent;
  bool accepted = false;
  switch (decide_by) {
    case DecideBy::kStereo:
      return stereo;
    case DecideBy::kLidarHoldout:
      return holdout;
    case DecideBy::kEither:
      accepted = one_accepts;
      break;
    case DecideBy::kBoth:
      accepted = one_accepts && !one_rejects && !holdout_missing;
      break;
  }
  if (accepted) return Verdict::kAccept;
  return one_rejects ? Verdict::kReject : Verdict::kNoEvidence;
}

}  // namespace alight
