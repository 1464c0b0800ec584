#include "infer/depth/image_task.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "foundation/config_reader.hpp"

namespace alight {

const char* name(DepthSource source) {
  switch (source) {
    case DepthSource::kNone:
      break;
    case DepthSource::kImage:
      return "image";
    case DepthSource::kLidar:
      return "lidar";
    case DepthSource::kFallback:
      return "fallback";
  }
  return "none";
}

void bind(Binder& b, ImageTaskConfig& c) {
  b.field("max_accumulation_s", c.max_accumulation_s, "LiDAR time after which the fallback is taken",
          between(0, 60));
  b.field("min_fallback_s", c.min_fallback_s, "less LiDAR time is no basis for a fallback", between(0, 60));
  b.check("min_fallback_s", c.min_fallback_s <= c.max_accumulation_s, "must not exceed max_accumulation_s");
  b.field("step_growth", c.step_growth, "factor by which packets grow between predictions; 1: every packet",
          between(1, 100));
  b.field("warm_images", c.warm_images,
          "images that begin with the packets that the one before needed, until one begins with half; 0: all "
          "begin alone",
          between(0, 1000));
  b.field("lidar_half_fov_deg", c.lidar_half_fov_deg, "half the opening of the LiDAR's circle",
          between(0.1, 90));
  b.field("min_depth_m", c.min_depth_m, "nearer depth is unknown", between(0.01, 1000));
  b.field("max_depth_m", c.max_depth_m, "farther depth is unknown", between(0.1, 10000));
  b.check("max_depth_m", c.max_depth_m > c.min_depth_m, "must exceed min_depth_m");
  b.section("self_evaluation", c.self_evaluation, "when a prediction is trusted");
  b.section("interpolation", c.interpolation, "what is done when none is");
}

ImageTask::ImageTask(const ImageTaskConfig& config, const RectifiedRig& rig, DepthPredictor* predictor,
                     std::int64_t t_ns, PredictorView view, const Eigen::Isometry3d& T_world_camera,
                     StageTimes stages_ms, int first_packets)
    : config_(config),
      rig_(rig),
      predictor_(predictor),
      T_camera_world_(T_world_camera.inverse()),
      stereo_test_(view.left, view.right, rig),
      view_(std::move(view)),
      known_(SparseDepth::empty(rig.intrinsics.size())),
      fed_(SparseDepth::empty(rig.intrinsics.size())),
      first_packets_(first_packets) {
  result_.t_ns = t_ns;
  result_.left = view_.left;
  view_.down_camera = T_world_camera.linear().transpose() * -Eigen::Vector3d::UnitZ();
  result_.T_world_camera = T_world_camera;
  result_.stages_ms = std::move(stages_ms);
}

void ImageTask::offer(WorldPacketPtr packet) {
  const StageTimer timer(result_.stages_ms, "project");
  // The first packet is the nearest to the image's time: its heights are those of the image's pose.
  if (!height_shift_m_) height_shift_m_ = packet->height_shift_m;
  const Eigen::Isometry3d T_camera_packet =
      T_camera_world_ * Eigen::Translation3d(0, 0, *height_shift_m_ - packet->height_shift_m);
  waiting_.push_back({points_in_image(packet->points, T_camera_packet, rig_.intrinsics, result_.t_ns,
                                      {config_.min_depth_m, config_.max_depth_m}),
                      packet->duration_s});
  add_points(waiting_.back().points, known_);
  lidar_view_.reset();
}

/// Half a packet more or less is as near to the wanted time as whole packets come.
bool ImageTask::full() const {
  return result_.accumulation_s + last_duration_s_ / 2 >= config_.max_accumulation_s;
}

int ImageTask::packets_wanted() const {
  if (predictor_ == nullptr) return 1;
  const int grown = static_cast<int>(std::ceil(fed_packets_ * config_.step_growth));
  return std::max(1, grown - fed_packets_);
}

/// How many of the waiting packets make the next step; 0 while there are too few. The last step may be a short one.
int ImageTask::packets_for_next_step() const {
  const int wanted = packets_wanted();
  double total_s = result_.accumulation_s;
  int count = 0;
  for (const Packet& packet : waiting_) {
    ++count;
    total_s += packet.duration_s;
    if (count == wanted || total_s + packet.duration_s / 2 >= config_.max_accumulation_s) return count;
  }
  return 0;
}

void ImageTask::feed(int packets) {
  for (int i = 0; i < packets && !waiting_.empty() && !full(); ++i) {
    const Packet packet = std::move(waiting_.front());
    waiting_.pop_front();
    add_points(packet.points, fed_);
    ++fed_packets_;
    result_.accumulation_s += packet.duration_s;
    last_duration_s_ = packet.duration_s;
  }
  predicted_ = false;
}

void ImageTask::predict() {
  if (!encoded_) {
    const StageTimer timer(result_.stages_ms, "encode");
    encoded_ = predictor_->encode(view_);
  }
  {
    const StageTimer timer(result_.stages_ms, "predict");
    prediction_m_ = predictor_->refine(*encoded_, fed_.depth_m);
    ++result_.predictions;
  }
  // Written so that a NaN is unknown, too.
  const cv::Mat usable = (prediction_m_ >= config_.min_depth_m) & (prediction_m_ <= config_.max_depth_m);
  prediction_m_.setTo(0, ~usable);
  predicted_ = true;
  holdout_done_ = stereo_done_ = false;
  result_.holdout = {};
  result_.holdout_verdict = result_.stereo_verdict = Verdict::kNoEvidence;
}

/// By the points that came, or else by what was predicted: the circle moves with the distance, as the LiDAR is not where
/// the camera is.
cv::Mat ImageTask::fov_mask() {
  return lidar_circle(known_.count() > 0 ? known_.depth_m : prediction_m_, rig_, config_.lidar_half_fov_deg);
}

/// The stereo test costs more than the other and is made where it can still change the decision; for the record it is made
/// once an image, of the last prediction.
bool ImageTask::stereo_decides(bool lidar_silent) const {
  return decide(Verdict::kAccept, result_.holdout_verdict, lidar_silent, config_.self_evaluation.decide_by) ==
         Verdict::kAccept;
}

void ImageTask::evaluate_stereo() {
  if (result_.predictions == 0 || stereo_done_ || !stereo_test_.has_right()) return;
  stereo_done_ = true;
  const StageTimer timer(result_.stages_ms, "evaluate");
  const RightView prediction = stereo_test_.reconstruct(prediction_m_);
  if (!lidar_view_ && known_.count() > 0) {
    lidar_view_ =
        stereo_test_.reconstruct(interpolate_inside_fov(known_.depth_m, fov_mask(), config_.interpolation));
  }
  result_.stereo = stereo_test_.score(prediction, lidar_view_ ? &*lidar_view_ : nullptr);
  const StereoTestConfig& test = config_.self_evaluation.stereo;
  const bool refused =
      config_.self_evaluation.decide_by == DecideBy::kBoth && result_.holdout_verdict == Verdict::kReject;
  const bool probe = test.probe > 0 && paper_accepts(result_.stereo, test);
  if (probe && !refused) result_.stereo.peak = stereo_test_.peak(prediction_m_, prediction, test.probe);
  // The probe costs as much as the rest of the test, and nothing could be accepted any more.
  result_.stereo_verdict = probe && refused ? Verdict::kNoEvidence : judge(result_.stereo, test);
}

void ImageTask::evaluate_holdout() {
  if (holdout_done_ || waiting_.empty()) return;
  const StageTimer timer(result_.stages_ms, "evaluate");
  SparseDepth holdout = SparseDepth::empty(rig_.intrinsics.size());
  add_points(waiting_.front().points, holdout);
  result_.holdout = compare_with_holdout(prediction_m_, holdout.depth_m, fed_.depth_m);
  result_.holdout_verdict = judge(result_.holdout, config_.self_evaluation.holdout);
  holdout_done_ = true;
}

/// Whoever asks for the hold-out's word cannot trust a prediction from all the LiDAR that it may have.
bool ImageTask::beyond_judgement(bool lidar_silent) const {
  const DecideBy by = config_.self_evaluation.decide_by;
  const bool holdout_decides = by == DecideBy::kLidarHoldout || (by == DecideBy::kBoth && !lidar_silent);
  return holdout_decides && full() && waiting_.empty();
}

bool ImageTask::advance(bool lidar_silent) {
  if (!predicted_ && fed_packets_ == 0) {
    feed(std::min(first_packets_, static_cast<int>(waiting_.size()) - 1));
  }
  while (!done_) {
    if (predictor_ != nullptr && !(result_.predictions > 0 && beyond_judgement(lidar_silent))) {
      if (!predicted_) predict();
      evaluate_holdout();
      if (stereo_decides(lidar_silent)) evaluate_stereo();
      if (decide(result_.stereo_verdict, result_.holdout_verdict, lidar_silent,
                 config_.self_evaluation.decide_by) == Verdict::kAccept) {
        accept();
        break;
      }
    }
    if (full()) {
      evaluate_stereo();
      fall_back(predictor_ != nullptr ? verdicts() : "LiDAR alone");
    } else if (const int packets = packets_for_next_step(); packets > 0) {
      feed(packets);
    } else {
      break;
    }
  }
  return done_;
}

void ImageTask::close(bool lidar_silent, const std::string& why) {
  if (advance(lidar_silent)) return;
  evaluate_stereo();
  const std::string reason = predictor_ != nullptr ? why + "; " + verdicts() : why;
  feed(static_cast<int>(waiting_.size()));
  fall_back(reason);
}

std::string ImageTask::verdicts() const {
  return fmt::format("prediction not trusted (stereo: {}, LiDAR hold-out: {})", name(result_.stereo_verdict),
                     name(result_.holdout_verdict));
}

void ImageTask::accept() {
  evaluate_stereo();
  const bool image_alone = fed_packets_ == 0;
  result_.depth_m = prediction_m_;
  result_.pixel_source = cv::Mat::zeros(prediction_m_.size(), CV_8UC1);
  result_.pixel_source.setTo(static_cast<int>(PixelSource::kPredictedOutsideFov), prediction_m_ > 0);
  result_.pixel_source.setTo(static_cast<int>(PixelSource::kPredicted), (prediction_m_ > 0) & fov_mask());
  const std::string text = fmt::format("trusted (stereo: {}, LiDAR hold-out: {})",
                                       name(result_.stereo_verdict), name(result_.holdout_verdict));
  finish(image_alone ? DepthSource::kImage : DepthSource::kLidar, text);
}

void ImageTask::fall_back(const std::string& why) {
  if (result_.accumulation_s + last_duration_s_ / 2 < config_.min_fallback_s || fed_.count() == 0) {
    const std::string text =
        fmt::format("; {:.2f} s of LiDAR are too little for a fallback", result_.accumulation_s);
    return finish(DepthSource::kNone, why + text);
  }
  {
    const StageTimer timer(result_.stages_ms, "interpolate");
    result_.depth_m = interpolate_inside_fov(fed_.depth_m, fov_mask(), config_.interpolation);
  }
  result_.pixel_source = cv::Mat::zeros(result_.depth_m.size(), CV_8UC1);
  result_.pixel_source.setTo(static_cast<int>(PixelSource::kInterpolated), result_.depth_m > 0);
  finish(DepthSource::kFallback, why);
}

void ImageTask::finish(DepthSource source, std::string reason) {
  result_.source = source;
  result_.reason = std::move(reason);
  result_.sparse_m = fed_.depth_m;
  encoded_.reset();
  waiting_.clear();
  done_ = true;
}

DepthResult ImageTask::take() { return std::move(result_); }

}  // namespace alight
