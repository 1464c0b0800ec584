#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "geometry/rig/rig.hpp"
#include "sensors/messages/decoders.hpp"
#include "sensors/stream/attitude_guard.hpp"
#include "sensors/stream/fix_guard.hpp"
#include "sensors/stream/log_config.hpp"
#include "sensors/stream/one_sensor.hpp"
#include "sensors/stream/point_time_guard.hpp"
#include "sensors/stream/repeat_guard.hpp"
#include "sensors/stream/stamp_guard.hpp"
#include "sensors/stream/stereo_pairing.hpp"

namespace alight {

/// From the bytes of ROS messages to what the engine takes: without those whose stamps cannot be true, decoded, with the rig's time shifts applied (Kalibr: t_imu =
/// t_sensor + timeshift) and left and right images paired. Logs and live topics go through this one class, so that the
/// same messages in the same order give the same results.
class MessageAssembler {
 public:
  MessageAssembler(const Rig& rig, const LogConfig& config);

  /// Only every n-th frame is decoded and handed on, the others are counted. For whoever does not need all of them.
  void keep_every_nth_image(int n) { every_nth_image_ = n; }
  /// From now on frames come undecoded: whoever takes them calls `decode`, on whatever thread.
  void put_off_decoding() { decodes_ = false; }
  /// Fills the images of a frame whose decoding was put off. @throws DecodeError as `add`
  void decode(StereoFrame& frame) const;

  /// @throws DecodeError if the bytes are not what the type promises, or an image has another size than the rig's camera
  void add(Sensor sensor, const Decoder& decoder, const RawMessage& raw);
  /// Looks at a LiDAR message that `add` gets later, to learn what the topic's point times mean. Logs show their first ones,
  /// since one cloud alone may be too short to tell; live there is none to show.
  void look_ahead(const Decoder& decoder, const RawMessage& raw);
  /// The next message that is complete; empty: there is none yet.
  std::optional<LogMessage> take();

  /// What held no measurement or is out of range: reason -> count.
  const std::map<std::string, std::int64_t>& dropped() const { return dropped_; }
  /// Images that had no partner, without those that still wait for one; and those.
  std::int64_t unpaired() const { return pairer_.unpaired(); }
  std::int64_t waiting() const { return pairer_.waiting(); }
  /// See StereoPairer.
  std::optional<std::int64_t> constant_lead_ns() const { return pairer_.constant_lead_ns(); }

 private:
  DecodeOptions options_of(Sensor sensor) const;
  DecodeOptions lidar_options();
  void accept(Sensor sensor, DecodedMessage decoded, std::int64_t receive_ns);
  template <class Sample>
  void accept_timed(Sample sample, double timeshift_s);
  void add_image(Sensor sensor, const Decoder& decoder, const RawMessage& raw);
  void accept_frame(UndecodedFrame undecoded);
  cv::Mat decode(Sensor sensor, const UndecodedImage& image) const;
  bool stamp_is_usable(Sensor sensor, std::int64_t t_ns, std::int64_t receive_ns);
  void accept_packet(LidarPacket packet);
  void accept_position(const PositionSample& position);

  Rig rig_;
  LogConfig config_;
  StereoPairer pairer_;
  int every_nth_image_ = 1;
  bool decodes_ = true;
  std::int64_t frames_seen_ = 0;
  std::map<Sensor, StampGuard> stamp_guards_;
  PointTimeMemory point_times_;
  PointTimeGuard point_time_guard_;
  OneSensor one_lidar_;
  FixGuard fix_guard_;
  AttitudeGuard attitude_guard_;
  std::map<Sensor, RepeatGuard> repeat_guards_;
  std::deque<LogMessage> ready_;
  std::map<std::string, std::int64_t> dropped_;
};

}  // namespace alight
