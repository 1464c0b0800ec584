#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "foundation/errors.hpp"
#include "geometry/rig/stereo_rectification.hpp"
#include "sensors/messages/message_types.hpp"
#include "sensors/poses/packet_aligner.hpp"
#include "sensors/poses/packet_window.hpp"

namespace alight {

/// How images and LiDAR points become sparse depth maps (paper 3.1).
struct DepthMapConfig {
  std::optional<int> crop_px = 352;  ///< side of the centred square that is kept; none: the whole image
  double window_before_s = 1.0;      ///< points measured up to this long before the image
  /// and after it. The onboard loop takes an image, then adds points as they arrive for up to a second: an
  /// input window is drawn from the points after the image, and the ones before are ground truth that it
  /// never sees.
  double window_after_s = 1.0;
  int every_nth_image = 4;  ///< that the log hands on: 20 Hz images of a slow vehicle are nearly alike
  double min_depth_m = 0.5;
  double max_depth_m = 250.0;
  double max_pose_gap_s = 0.25;  ///< poses are not interpolated across longer gaps
  int min_pixels = 50;           ///< images with fewer depth pixels are dropped
};
void bind(Binder& b, DepthMapConfig& c);

/// An image with its sparse depth map.
struct BuiltSample {
  std::int64_t t_ns = 0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  StereoFrame frame;  ///< as it came, where its decoding was put off
  cv::Mat left;       ///< rectified and cropped; empty where decoding was put off, until add_images
  cv::Mat right;
  SparseDepth sparse;
  int points = 0;  ///< LiDAR points that fell into the image
  double height_m = 0;
};

/// From the messages of one flight, in the order of the log, to samples; one pass, bounded memory. An image
/// waits until the poses and points of its window are there, or until the log has moved on long enough to
/// give them up.
class DepthMapBuilder {
 public:
  /// @throws ConfigError if the crop does not fit the rig's images
  DepthMapBuilder(const Rig& rig, const DepthMapConfig& config);

  /// Of the rectified, cropped images.
  const RectifiedRig& rig() const { return cropped_; }
  /// Where the crop lies in the rectified image.
  const cv::Rect& crop_rect() const { return crop_; }
  /// True if rectification changes nothing, so that pictures of the raw image can be cropped alike.
  bool is_identity_rectification() const { return rectifier_.is_identity(); }

  void add(LogMessage message);
  /// No message follows: what still waits is built with what is there.
  void finish() { aligner_.finish(); }
  /// The next sample in time order that is ready; empty if none is.
  std::optional<BuiltSample> next();

  /// Rectifies and crops the images of a frame that was decoded later. Safe on any thread, while others add and take.
  void add_images(BuiltSample& sample, const StereoFrame& frame) const;

  /// What was left out so far: reason -> count.
  const std::map<std::string, std::int64_t>& dropped() const { return aligner_.dropped(); }

 private:
  void add_frame(StereoFrame frame);
  bool frame_is_ready(std::int64_t t_ns) const;
  std::optional<BuiltSample> build(StereoFrame frame);
  void forget();

  DepthMapConfig config_;
  StereoRectifier rectifier_;
  cv::Rect crop_;
  RectifiedRig cropped_;
  std::int64_t before_ns_;
  std::int64_t after_ns_;

  PacketAligner aligner_;
  PacketWindow window_;
  std::deque<StereoFrame> frames_;  // waiting for the poses and points of their window
  std::optional<std::int64_t> last_frame_ns_;
};

}  // namespace alight
