#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "foundation/binder_fwd.hpp"
#include "geometry/projection.hpp"
#include "infer/depth/depth_predictor.hpp"
#include "infer/depth/depth_result.hpp"
#include "infer/depth/interpolation.hpp"
#include "infer/depth/self_evaluation.hpp"
#include "sensors/poses/alignment.hpp"

namespace alight {

/// How one image is worked on.
struct ImageTaskConfig {
  double max_accumulation_s =
      1.0;  ///< LiDAR time after which the fallback is taken (the paper's "about 1 second")
  double min_fallback_s = 0.5;  ///< less LiDAR time than this is no basis for a fallback
  /// Between two predictions the number of packets grows by this factor, and by one at least. 1: predict at every
  /// packet, as the paper does; 2: at 0, 1, 2, 4, 8 packets, which bounds the work on an unfamiliar scene.
  double step_growth = 2.0;
  /// What was needed a twentieth of a second ago is needed now: so many images begin with the packets that the one before
  /// them needed, then one begins with half of them, so that the number can shrink to the image alone. After an image that
  /// fell back, so many are interpolated without a prediction, which would be refused as well. Most images then cost one
  /// prediction. 0: every image begins alone, the paper.
  int warm_images = 3;
  double lidar_half_fov_deg = 19.174;  ///< the Mid-40's circle
  double min_depth_m = 0.5;
  double max_depth_m = 150.0;
  SelfEvaluationConfig self_evaluation;
  InterpolationConfig interpolation;
};
void bind(Binder& b, ImageTaskConfig& c);

/// Dynamic-time inference of one image (paper 3.2): predict from the image alone, evaluate; while not trusted, take more
/// LiDAR, predict again, evaluate; when the LiDAR time is used up, interpolate. A packet that was not fed yet is first
/// compared with the prediction (hold-out), then fed. Every packet costs its own projection and nothing else.
class ImageTask {
 public:
  /// @param view rectified, cropped; `right` empty for mono; down_camera is set from the pose. @param predictor null:
  /// LiDAR alone, which waits for max_accumulation_s and interpolates (paper 3.3, state 8). @param first_packets fed before
  /// the first prediction, as far as they are there and one is left to judge by
  ImageTask(const ImageTaskConfig& config, const RectifiedRig& rig, DepthPredictor* predictor,
            std::int64_t t_ns, PredictorView view, const Eigen::Isometry3d& T_world_camera,
            StageTimes stages_ms, int first_packets = 0);

  /// Puts a packet at the end of the queue. Order of the calls is the order of feeding.
  void offer(WorldPacketPtr packet);
  /// Goes on as far as the queue allows. @returns true when the result is final
  bool advance(bool lidar_silent);
  /// Ends the task with what there is.
  void close(bool lidar_silent, const std::string& why);

  std::int64_t t_ns() const { return result_.t_ns; }
  bool done() const { return done_; }
  int packets_fed() const { return fed_packets_; }
  bool asked_network() const { return predictor_ != nullptr; }
  /// Call once, when done.
  DepthResult take();

 private:
  void feed(int packets);
  int packets_for_next_step() const;
  int packets_wanted() const;
  bool full() const;
  bool beyond_judgement(bool lidar_silent) const;
  void predict();
  bool stereo_decides(bool lidar_silent) const;
  void evaluate_stereo();
  void evaluate_holdout();
  cv::Mat fov_mask();
  void accept();
  void fall_back(const std::string& why);
  void finish(DepthSource source, std::string reason);
  std::string verdicts() const;

  ImageTaskConfig config_;
  RectifiedRig rig_;
  DepthPredictor* predictor_;
  Eigen::Isometry3d T_camera_world_;
  StereoTest stereo_test_;
  PredictorView view_;
  std::unique_ptr<EncodedImage> encoded_;
  /// What of a packet falls into the image.
  struct Packet {
    std::vector<PixelPoint> points;
    double duration_s = 0;
  };
  std::deque<Packet> waiting_;
  SparseDepth known_;  // every point that came, fed or not: the reference of the stereo test
  SparseDepth fed_;
  std::optional<double> height_shift_m_;  // of the packets' heights at the image's time
  int first_packets_ = 0;
  int fed_packets_ = 0;
  double last_duration_s_ = 0;
  cv::Mat prediction_m_;
  std::optional<RightView> lidar_view_;  // from known_
  bool predicted_ = false;
  bool holdout_done_ = false;
  bool stereo_done_ = false;
  bool done_ = false;
  DepthResult result_;
};

}  // namespace alight
