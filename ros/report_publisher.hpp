#pragma once

#include <mutex>
#include <optional>
#include <string>

#include <ros/node_handle.h>

#include "infer/onboard/frame_sink.hpp"
#include "infer/onboard/mode_switch.hpp"
#include "ros/node_config.hpp"

namespace alight {

/// Publishes every result, on the engine's thread: making all messages of an image takes a few milliseconds, and what
/// nobody subscribes to is not made.
class ReportPublisher : public FrameSink {
 public:
  /// @param engine the camera and the crop of the results. @param mode outlives the publisher
  ReportPublisher(ros::NodeHandle node, const NodeConfig& config, const DepthEngine& engine,
                  const ModeSwitch& mode);

  void on_frame(const FrameReport& frame) override;
  /// The last result; any thread.
  std::optional<FrameReport> last() const;
  /// The time has jumped: there is no last result.
  void forget();

 private:
  void publish_images(const FrameReport& frame);
  void publish_site(const FrameReport& frame);

  NodeConfig config_;
  PinholeIntrinsics intrinsics_;
  cv::Rect crop_;
  const ModeSwitch& mode_;
  ros::Publisher depth_;
  ros::Publisher camera_info_;
  ros::Publisher points_;
  ros::Publisher safe_mask_;
  ros::Publisher site_;
  ros::Publisher marker_;
  ros::Publisher result_;
  ros::Publisher tf_;
  mutable std::mutex mutex_;
  std::optional<FrameReport> last_;
};

}  // namespace alight
