#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "geometry/rig/rig.hpp"
#include "geometry/rig/stereo_rectification.hpp"
#include "infer/health/camera_alignment.hpp"
#include "infer/health/camera_watch.hpp"
#include "infer/health/health_config.hpp"
#include "infer/health/health_report.hpp"
#include "infer/health/lidar_watch.hpp"
#include "infer/health/pose_watch.hpp"
#include "infer/health/stream_watch.hpp"
#include "sensors/messages/message_types.hpp"

namespace alight {

/// Which depth can be made.
enum class DepthMakers {
  kImageAndLidar,  ///< a network: from the image, the LiDAR or both
  kLidar,          ///< no network: from the LiDAR alone
};

/// Judges the sensors by their messages and passes on what may be used. Stands between the sensors and the engine; knows
/// no clock but the messages' times, so the same messages give the same verdicts.
///
/// What looks wrong is not used from the first sign on; a finding takes HealthConfig::confirm_s more. A finding about one
/// sensor degrades: a bad left camera leaves the LiDAR, a bad right camera leaves one camera, a bad LiDAR leaves the images.
/// Without a pose, or with neither depth from LiDAR nor a stereo pair to judge a prediction by, the state is failed.
class HealthMonitor {
 public:
  /// @throws ConfigError as StereoRectifier
  HealthMonitor(const HealthConfig& config, const Rig& rig, DepthMakers makers);

  /// Judges a message. @returns what the engine may have now, in its order: bad images are empty (a frame without a left
  /// image is worked on by LiDAR alone), bad packets are missing, a packet comes once the pose at its end is known.
  std::vector<LogMessage> add(const LogMessage& message);
  /// No more messages will come. @returns the packets that still waited for a pose
  std::vector<LogMessage> finish();

  /// True once after LiDAR that was passed on turned out to be wrong: whoever holds it forgets it.
  bool take_lidar_spoiled();
  /// No images come, or none that is on the common clock; the caller may let the LiDAR go on alone.
  bool camera_lost() const { return !stream(Stream::kCamera).usable(); }

  /// As of the latest message.
  HealthReport report() const;
  /// As of a later moment without a further message: for whoever has a clock and waits in vain.
  HealthReport report(std::int64_t now_ns) const;

 private:
  using Passed = std::vector<LogMessage>;

  bool believe(Stream stream, std::int64_t t_ns);
  void pass_time(std::int64_t now_ns);
  void receive(const StereoFrame& frame, Passed& passed);
  void receive(const LidarPacket& packet, Passed& passed);
  void receive(const AttitudeSample& sample, Passed& passed);
  void receive(const PositionSample& sample, Passed& passed);
  void receive(const HeightSample& sample, Passed& passed);
  template <class Sample>
  void receive_pose(Stream stream, const Sample& sample, Passed& passed);
  void judge_cameras(const StereoFrame& frame);
  void release_packets(bool all, Passed& passed);
  void spoil_lidar();
  std::optional<double> ground_distance_m() const;
  bool lidar_usable() const;
  bool stereo_usable() const;
  bool pose_usable() const;
  HealthState state(bool findings) const;
  StreamWatch& stream(Stream s) { return streams_[static_cast<std::size_t>(s)]; }
  const StreamWatch& stream(Stream s) const { return streams_[static_cast<std::size_t>(s)]; }

  HealthConfig config_;
  DepthMakers makers_;
  bool expects_right_;
  StereoRectifier rectifier_;
  MessageClock clock_;
  std::optional<std::int64_t> begin_ns_;
  std::int64_t now_ns_ = 0;
  std::vector<StreamWatch> streams_;
  CameraWatch left_;
  CameraWatch right_;
  CameraAlignment alignment_;
  LidarWatch lidar_;
  PoseWatch pose_;
  std::optional<HeightSample> height_;
  std::deque<LidarPacket> waiting_;  // for the pose at their end
  bool lidar_spoiled_ = false;
};

}  // namespace alight
