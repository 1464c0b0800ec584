#pragma once

#include <optional>
#include <string>
#include <vector>

#include "foundation/binder_fwd.hpp"
#include "foundation/errors.hpp"
#include "geometry/rig/rig.hpp"
#include "sensors/messages/decoders.hpp"

namespace alight {

/// How a log or live topics are read. Topics of cameras and LiDAR stand in the rig; with `/compressed` appended they are
/// found too.
struct LogConfig {
  std::string attitude_topic = "/dji_sdk/attitude";
  std::string position_topic = "/dji_sdk/gps_position";
  std::optional<std::string> height_topic = "/dji_sdk/height_above_takeoff";  ///< none: heights are unknown
  StampSource attitude_stamp = StampSource::kHeader;
  StampSource position_stamp = StampSource::kHeader;
  double attitude_timeshift_s = 0;  ///< t_imu = t_attitude + timeshift
  double position_timeshift_s = 0;
  double height_timeshift_s = 0;
  std::string
      tf_world_frame;  ///< where attitude or position come from a tree of transforms: of which to which frame
  std::string tf_body_frame;
  double stereo_pair_tolerance_s = 0.002;  ///< left and right of one exposure differ by no more than this
  double right_stamp_lead_s = 0;           ///< the right camera's stamps are ahead of the left one's by this
  double min_range_m = 0.5;                ///< LiDAR returns nearer than this are dropped
  double max_range_m = 300.0;              ///< and farther than this
  double max_bad_message_share = 0.01;     ///< of a topic's messages; more that do not decode are fatal
};
void bind(Binder& b, LogConfig& c);

/// What a topic is read for; unlike a LogRole it tells left from right.
enum class Sensor { kLeft, kRight, kLidar, kAttitude, kPosition, kHeight };
/// "left camera", "right camera", "LiDAR", "attitude", "position", "height"
const char* name(Sensor sensor);
LogRole role(Sensor sensor);

/// A topic and what it is read for.
struct SensorTopic {
  Sensor sensor = Sensor::kLeft;
  std::string topic;
};
/// The topics of a rig's sensors and of the vehicle. @throws ConfigError if the rig names none for a camera or LiDAR
std::vector<SensorTopic> sensor_topics(const Rig& rig, const LogConfig& config);

/// The decoder of a topic's messages. @throws DataError, which names topic and sensor, if the type has none or is of
/// another version
const Decoder& require_decoder(const SensorTopic& topic, const std::string& type, const std::string& md5);

}  // namespace alight
