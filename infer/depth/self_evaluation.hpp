#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "geometry/rig/stereo_rectification.hpp"

namespace alight {

/// What a test says about a predicted depth map.
enum class Verdict { kAccept, kReject, kNoEvidence };
const char* name(Verdict verdict);

/// The paper's stereo test (3.2, "Self-evaluation Method").
struct StereoTestConfig {
  double min_gain = 0.2;  ///< accepted when sim_pred > sim + min_gain
  /// The first rule, sim_pred > (sim + sim_d) / 2, compares against half the way between doing nothing and the
  /// LiDAR. Where these two lie closer together than this (at 30 m the disparity is 1.2 px) the rule is a coin toss, so
  /// the test abstains. 0: the paper.
  double min_contrast = 0.05;
  double min_share = 0.05;  ///< of the image that must be comparable, else the test abstains
  /// Both rules above pass a depth that is wrong by a third where texture is soft: half a pixel of disparity costs half
  /// of the similarity. So a depth that passes is compared with itself moved nearer and farther by this share, and has
  /// to be the best of the three; if all three look alike the stereo pair is blind to such an error and the test
  /// abstains. 0: off, the paper.
  double probe = 0.15;
  double min_peak = 0.01;  ///< by how much similarity it has to be the best
};
void bind(Binder& b, StereoTestConfig& c);

/// Mean SSIM with the right image, all over the same pixels.
struct StereoScores {
  std::optional<double> sim;       ///< left image as it is
  std::optional<double> sim_d;     ///< left image moved by the LiDAR depth; absent without LiDAR
  std::optional<double> sim_pred;  ///< left image moved by the prediction
  double share = 0;                ///< of the image's pixels that were compared
  /// Similarity of the prediction less that of the better one of its two neighbours, over pixels that all three see;
  /// absent where the probe was not asked for.
  std::optional<double> peak;
};

/// Whether one of the paper's two rules accepts.
bool paper_accepts(const StereoScores& scores, const StereoTestConfig& config);

/// Accept by either of the paper's two rules and by the probe where one was made, else reject. Without LiDAR depth there is no sim_d and only the second
/// rule can accept. No evidence: mono, too few comparable pixels, or too little contrast (see the configuration).
Verdict judge(const StereoScores& scores, const StereoTestConfig& config);

/// The right image made from the left one, beside the true one.
struct RightView {
  cv::Mat similarity;  ///< CV_32FC1, SSIM of the two; empty without a right image
  cv::Mat valid;       ///< CV_8UC1, 255 where a surface was seen by both cameras
};

/// Scores depth maps of one stereo pair.
class StereoTest {
 public:
  /// Rectified, cropped images (grey or BGR); an empty `right` makes a test without evidence.
  StereoTest(const cv::Mat& left, const cv::Mat& right, const RectifiedRig& rig);

  bool has_right() const { return !right_.empty(); }
  /// @param depth_m CV_32FC1 plane depth of the left camera, 0 = unknown
  RightView reconstruct(const cv::Mat& depth_m) const;
  /// `lidar` may be null. A pixel counts where the 3x3 windows of all views are valid.
  StereoScores score(const RightView& prediction, const RightView* lidar) const;
  /// See StereoScores::peak. `prediction` is reconstruct(depth_m). Empty without a pixel to compare.
  std::optional<double> peak(const cv::Mat& depth_m, const RightView& prediction, double probe) const;

 private:
  RectifiedRig rig_;
  cv::Mat left_;        // CV_32FC1
  cv::Mat right_;       // CV_32FC1, empty: mono
  cv::Mat ssim_plain_;  // left against right
};

/// The second test (METHOD, "Self-evaluation", beyond the paper): LiDAR points that were not fed. Needs no altitude.
struct HoldoutTestConfig {
  /// Median of |error| / depth. 8 cm at 20 m: the lowest step that the site selection can tell from flat ground is 9 cm
  /// (DerivativesConfig), so depth that is off by more is no basis for it.
  double max_median_relative = 0.004;
  double max_rms_relative =
      0.015;  ///< root mean square of error / depth, which sees wrong edges (docs/results/self_evaluation.md)
  int min_points = 100;  ///< fewer say nothing
};
void bind(Binder& b, HoldoutTestConfig& c);

/// Errors at the held-out pixels.
struct HoldoutScores {
  int points = 0;
  double median_m = 0;
  double rms_m = 0;
  double median_relative = 0;
  double rms_relative = 0;
};

/// @param holdout_m CV_32FC1, 0 = no point. @param fed_m what the prediction was made from: its pixels do not count
/// A pixel that the prediction leaves unknown counts as wholly wrong.
HoldoutScores compare_with_holdout(const cv::Mat& prediction_m, const cv::Mat& holdout_m,
                                   const cv::Mat& fed_m);
Verdict judge(const HoldoutScores& scores, const HoldoutTestConfig& config);

/// Which test decides; both are always logged.
enum class DecideBy {
  kStereo,        ///< the paper
  kLidarHoldout,  ///< LiDAR alone
  kEither,        ///< one accepts, whatever the other says
  kBoth,          ///< nobody rejects, one accepts, and the hold-out abstains only while the LiDAR is silent
};

/// The default is the strictest rule: a wrong depth that passes for right is the one unforgivable result, while a
/// right one that is refused costs accumulation time.
struct SelfEvaluationConfig {
  DecideBy decide_by = DecideBy::kBoth;
  StereoTestConfig stereo;
  HoldoutTestConfig holdout;
};
void bind(Binder& b, SelfEvaluationConfig& c);

/// kAccept alone means: trust the prediction.
Verdict decide(Verdict stereo, Verdict holdout, bool lidar_silent, DecideBy decide_by);

}  // namespace alight
