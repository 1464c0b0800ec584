#include "train/evaluation/self/self_scores.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <future>
#include <optional>
#include <thread>
#include <utility>

#include "foundation/errors.hpp"
#include "geometry/depth_map.hpp"
#include "infer/depth/interpolation.hpp"
#include "train/data/density_sampling.hpp"
#include "train/evaluation/methods/baseline_methods.hpp"
#include "train/evaluation/methods/delaunay.hpp"

namespace alight {
namespace {

/// All maps of one sample.
class SampleScoring {
 public:
  SampleScoring(const DepthMethod& network, DepthSample sample, const EvaluationItem& item,
                const RectifiedRig& rig, const SelfScoreConfig& config)
      : network_(network),
        sample_(std::move(sample)),
        item_(item),
        rig_(rig),
        config_(config),
        truth_m_(dense_truth()),
        depth_m_(median_depth_m(truth_m_).value_or(0)),
        stereo_test_(tensor_to_image(sample_.left),
                     sample_.has_right ? tensor_to_image(sample_.right) : cv::Mat(), rig) {}

  std::vector<MapScores> all() {
    for (const double window_s : config_.windows_s) score_window(window_s);
    return std::move(scores_);
  }

 private:
  cv::Mat dense_truth() const {
    if (sample_.dense.defined()) return tensor_to_depth(sample_.dense);
    throw DataError(
        "flight " + item_.flight + ", sample " + std::to_string(item_.index) +
        ": has no dense true depth, without which depth maps cannot be told good from bad; take a "
        "data set of simulated flights");
  }

  torch::Tensor points(double begin_s, double end_s) const {
    return keep_window(sample_.sparse, sample_.offset_s, begin_s, torch::tensor(end_s));
  }

  void score_window(double window_s) {
    const torch::Tensor fed = points(0, window_s);
    const double holdout_end_s = window_s + config_.holdout_s;
    fed_m_ = tensor_to_depth(fed);
    holdout_m_ = tensor_to_depth(points(window_s, holdout_end_s));
    lidar_view_ = view_of_lidar(tensor_to_depth(points(0, holdout_end_s)));
    const cv::Mat network_m = tensor_to_depth(network_.complete(sample_, fed));
    DepthSample wrong_height = sample_;  // shares the tensors
    wrong_height.height_m *= config_.height_factor;
    const auto plane = make_altitude_plane({config_.image.max_depth_m, BaselineConfig().ip_basic_range_m});
    score(window_s, MapOrigin::kNetwork, network_m);
    score(window_s, MapOrigin::kAltitudePlane, tensor_to_depth(plane->complete(sample_, fed)));
    score(window_s, MapOrigin::kWrongHeight, tensor_to_depth(network_.complete(wrong_height, fed)));
    score(window_s, MapOrigin::kTooFar, network_m * config_.depth_factor);
    score(window_s, MapOrigin::kTooNear, network_m * (2 - config_.depth_factor));
    if (cv::countNonZero(fed_m_) > 0) score(window_s, MapOrigin::kDelaunay, fill_delaunay(fed_m_));
  }

  std::optional<RightView> view_of_lidar(const cv::Mat& known_m) const {
    if (!stereo_test_.has_right() || cv::countNonZero(known_m) == 0) return std::nullopt;
    const cv::Mat fov = lidar_circle(known_m, rig_, config_.image.lidar_half_fov_deg);
    return stereo_test_.reconstruct(interpolate_inside_fov(known_m, fov, config_.image.interpolation));
  }

  void score(double window_s, MapOrigin origin, cv::Mat predicted_m) {
    // As ImageTask::predict: outside the range, and what is no number, is unknown.
    const cv::Mat usable =
        (predicted_m >= config_.image.min_depth_m) & (predicted_m <= config_.image.max_depth_m);
    predicted_m.setTo(0, ~usable);
    MapScores scores;
    scores.flight = item_.flight;
    scores.sample = item_.index;
    scores.window_s = window_s;
    scores.origin = origin;
    scores.depth_m = depth_m_;
    for (const GoodDepth& good : config_.good) {
      scores.share_within.push_back(share_within(predicted_m, truth_m_, good));
      scores.good.push_back(scores.share_within.back() >= good.share);
    }
    judge_map(predicted_m, scores);
    scores_.push_back(std::move(scores));
  }

  void judge_map(const cv::Mat& predicted_m, MapScores& scores) const {
    const SelfEvaluationConfig& tests = config_.image.self_evaluation;
    if (stereo_test_.has_right()) {
      const RightView prediction = stereo_test_.reconstruct(predicted_m);
      scores.stereo = stereo_test_.score(prediction, lidar_view_ ? &*lidar_view_ : nullptr);
      // The verdict is the onboard loop's, which makes the probe only after the paper's rules accepted: they come first.
      if (tests.stereo.probe > 0)
        scores.stereo.peak = stereo_test_.peak(predicted_m, prediction, tests.stereo.probe);
    }
    scores.stereo_verdict = judge(scores.stereo, tests.stereo);
    scores.holdout = compare_with_holdout(predicted_m, holdout_m_, fed_m_);
    scores.holdout_verdict = judge(scores.holdout, tests.holdout);
  }

  const DepthMethod& network_;
  DepthSample sample_;
  const EvaluationItem& item_;
  const RectifiedRig& rig_;
  const SelfScoreConfig& config_;
  cv::Mat truth_m_;
  double depth_m_;
  StereoTest stereo_test_;
  // Of the window in work.
  cv::Mat fed_m_;
  cv::Mat holdout_m_;
  std::optional<RightView> lidar_view_;
  std::vector<MapScores> scores_;
};

}  // namespace

const char* name(MapOrigin origin) {
  switch (origin) {
    case MapOrigin::kNetwork:
      return "network";
    case MapOrigin::kAltitudePlane:
      return "altitude_plane";
    case MapOrigin::kWrongHeight:
      return "wrong_height";
    case MapOrigin::kTooFar:
      return "too_far";
    case MapOrigin::kTooNear:
      return "too_near";
    case MapOrigin::kDelaunay:
      break;
  }
  return "delaunay";
}

double share_within(const cv::Mat& predicted_m, const cv::Mat& truth_m, const GoodDepth& tolerance) {
  const int known = cv::countNonZero(truth_m > 0);
  if (known == 0) return 0;
  cv::Mat error_m;
  cv::absdiff(predicted_m, truth_m, error_m);
  const cv::Mat allowed_m = cv::max(truth_m * tolerance.error_relative, tolerance.error_m);
  const cv::Mat within = (truth_m > 0) & (predicted_m > 0) & (error_m <= allowed_m);
  return static_cast<double>(cv::countNonZero(within)) / known;
}

std::vector<MapScores> score_maps(const DepthMethod& network, SampleSource& source,
                                  const std::vector<EvaluationItem>& items, const RectifiedRig& rig,
                                  const SelfScoreConfig& config, const std::function<void()>& progress) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  const std::size_t at_once = config.threads > 0 ? static_cast<std::size_t>(config.threads) : cores;
  std::deque<std::future<std::vector<MapScores>>> pending;
  std::size_t started = 0;
  std::vector<MapScores> all;
  for (std::size_t done = 0; done < items.size(); ++done) {
    while (started < items.size() && pending.size() < at_once) {
      pending.push_back(std::async(std::launch::async, [&, &item = items[started++]] {
        at::set_num_threads(1);  // the samples share the cores
        return SampleScoring(network, source.get(item.index), item, rig, config).all();
      }));
    }
    const std::vector<MapScores> scores = pending.front().get();
    pending.pop_front();
    all.insert(all.end(), scores.begin(), scores.end());
    if (progress) progress();
  }
  return all;
}

}  // namespace alight
