#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "foundation/binder_fwd.hpp"
#include "geometry/rig/stereo_rectification.hpp"
#include "infer/depth/depth_result.hpp"
#include "infer/depth/height_registration.hpp"
#include "infer/depth/image_task.hpp"
#include "infer/health/health_config.hpp"
#include "sensors/messages/message_types.hpp"
#include "sensors/poses/packet_aligner.hpp"
#include "sensors/poses/packet_window.hpp"

namespace alight {

/// What a newer image does to one that still waits for LiDAR.
enum class NewerImage {
  kFinish,  ///< nothing: every image is refined until it is trusted or its time is up
  kLatest,  ///< ends it with what there is: all work goes to the newest
};

/// How messages become depth maps.
struct DepthEngineConfig {
  int width_px = 352;  ///< centre crop of the rectified images
  int height_px = 352;
  /// LiDAR of the recent past that an image may use, newest packets first, before it waits for new ones. 0: only LiDAR
  /// that comes after the image, as the paper does.
  double history_s = 1.0;
  /// Packets are shifted in height onto the ground of those before, against a receiver's height that wanders within a
  /// second. Results stay where the pose at the image's time is.
  bool register_heights = true;
  double max_pose_gap_s = 0.1;   ///< poses further apart are not interpolated between
  double max_wait_s = 0.5;       ///< how late a pose or a LiDAR packet may come
  double lidar_timeout_s = 0.5;  ///< without a packet for so long the LiDAR counts as silent
  NewerImage newer_image = NewerImage::kFinish;
  int max_open_images = 24;    ///< images in work at once; more are skipped with a reason
  int max_points = 2'000'000;  ///< LiDAR points held for the future
  ImageTaskConfig image;
  HealthConfig health;  ///< LandingPipeline's; the engine itself believes every message
};
void bind(Binder& b, DepthEngineConfig& c);

/// The onboard loop (METHOD, "Dynamic-time inference"): time-stamped messages in, one depth map with a verdict per left
/// image out. Knows no ROS, no file and no clock but the messages' times: the same messages in the same order give the
/// same results.
///
/// Design. An image is opened once poses bracket its time. It is then judged from the image alone, and refined with
/// LiDAR packets one step at a time until it is trusted or max_accumulation_s of LiDAR time is in it. Where the packets
/// come from is the one choice that the paper leaves no room for and flight does: a vehicle that has been flying for a
/// second *already has* a second of LiDAR, and it needs no more than a pose to use it. So packets that ended before the
/// image are offered first, newest first (`history_s`), then those that arrive. An image then gets its result at once
/// and stays open only in the first second of a flight or after a LiDAR pause. With history_s = 0 an image waits for the
/// LiDAR that follows it, as in the paper; max_open_images = 1 makes that the paper's one-image-at-a-time loop. A newer
/// image leaves older ones to be finished, or ends them (`newer_image`).
/// `accumulation_s` is the LiDAR time that was fed, wherever it came from.
///
/// Nothing waits for ever: an image or packet without a pose is given up after max_wait_s, an open image after
/// max_accumulation_s + max_wait_s, or as soon as the LiDAR is silent and the prediction is not trusted. Results leave
/// in image order, since the five-frame rule counts consecutive frames.
class DepthEngine {
 public:
  /// @param predictor null: LiDAR alone. @throws ConfigError if the crop does not fit or the rig has no LiDAR
  DepthEngine(const DepthEngineConfig& config, const Rig& rig, std::shared_ptr<DepthPredictor> predictor);

  /// A frame without a left image gets its result from the LiDAR alone.
  void add(const LogMessage& message);
  /// The LiDAR points so far are wrong or lie elsewhere: none is used any more, and images in work end without depth.
  void forget_lidar(const std::string& reason);
  /// No more messages will come: every image gets its result.
  void finish();
  /// The results that are final, in image order.
  std::vector<DepthResult> take_results();

  /// Rectified and cropped, as the results' images.
  const RectifiedRig& rig() const { return rig_; }
  /// Where the results' images lie in the rectified left image.
  const cv::Rect& crop() const { return crop_; }
  /// What was left out: reason -> count.
  const std::map<std::string, std::int64_t>& dropped() const { return aligner_.dropped(); }
  /// Images without a delivered result, and LiDAR points held: both bounded in an endless flight.
  std::size_t images_in_flight() const { return entries_.size(); }
  std::size_t points_held() const { return window_.points(); }

 private:
  /// An image on its way: waiting for a pose (frame), in work (task) or final (result).
  struct Entry {
    std::int64_t t_ns = 0;
    std::optional<StereoFrame> frame;
    std::unique_ptr<ImageTask> task;
    std::optional<DepthResult> result;
  };

  void receive(const StereoFrame& frame);
  void receive(const LidarPacket& packet);

  void work();
  void place(WorldPacket packet);
  void open_images();
  void open(Entry& entry, const Eigen::Isometry3d& T_world_camera);
  void pre_empt_before(std::int64_t t_ns);
  void advance_tasks();
  void forget();
  void give_up(Entry& entry, const std::string& reason);
  void conclude(Entry& entry);
  bool lidar_silent() const;
  int open_count() const;
  void begin_warm(int& first_packets, bool& ask_network);
  void learn_from(const ImageTask& task, DepthSource source);

  DepthEngineConfig config_;
  StereoRectifier rectifier_;
  cv::Rect crop_;
  RectifiedRig rig_;
  std::shared_ptr<DepthPredictor> predictor_;
  PacketAligner aligner_;
  PacketWindow window_;
  HeightRegistration registration_;
  std::deque<Entry> entries_;  // images without a delivered result, in order of arrival
  std::optional<std::int64_t> last_image_ns_;
  std::int64_t lidar_ns_ = 0;  // end of the latest packet, or the first message
  /// What the images before needed; see ImageTaskConfig::warm_images.
  struct Warmth {
    int packets = 0;
    bool fell_back = false;
    int images = 0;  // that began with it
  } warmth_;
};

}  // namespace alight
