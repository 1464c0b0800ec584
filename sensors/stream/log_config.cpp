#include "sensors/stream/log_config.hpp"

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"

namespace alight {
namespace {

struct SensorName {
  LogRole role;
  const char* name;
};
SensorName describe(Sensor sensor) {
  switch (sensor) {
    case Sensor::kLeft:
      return {LogRole::kImage, "left camera"};
    case Sensor::kRight:
      return {LogRole::kImage, "right camera"};
    case Sensor::kLidar:
      return {LogRole::kLidar, "LiDAR"};
    case Sensor::kAttitude:
      return {LogRole::kAttitude, "attitude"};
    case Sensor::kPosition:
      return {LogRole::kPosition, "position"};
    case Sensor::kHeight:
      break;
  }
  return {LogRole::kHeight, "height"};
}

}  // namespace

void bind(Binder& b, LogConfig& c) {
  b.field("attitude_topic", c.attitude_topic,
          "attitude of the vehicle: " + accepted_types(LogRole::kAttitude));
  b.field("position_topic", c.position_topic,
          "position of the vehicle: " + accepted_types(LogRole::kPosition));
  b.field("height_topic", c.height_topic,
          "height above take-off, or none: " + accepted_types(LogRole::kHeight));
  bind_stamp(b, "attitude_stamp", c.attitude_stamp);
  bind_stamp(b, "position_stamp", c.position_stamp);
  b.field("attitude_timeshift_s", c.attitude_timeshift_s, "t_imu = t_attitude + timeshift");
  b.field("position_timeshift_s", c.position_timeshift_s, "t_imu = t_position + timeshift");
  b.field("height_timeshift_s", c.height_timeshift_s, "t_imu = t_height + timeshift");
  b.field("tf_world_frame", c.tf_world_frame,
          "frames of a topic of transforms: the vehicle's pose is that of");
  b.field("tf_body_frame", c.tf_body_frame, "tf_body_frame in tf_world_frame");
  b.field("stereo_pair_tolerance_s", c.stereo_pair_tolerance_s,
          "left and right of one exposure differ by no more", at_least(0));
  b.field("right_stamp_lead_s", c.right_stamp_lead_s,
          "the right camera's stamps are ahead of the left one's by this");
  b.field("min_range_m", c.min_range_m, "LiDAR returns nearer than this are dropped", at_least(0));
  b.field("max_range_m", c.max_range_m, "LiDAR returns farther than this are dropped", positive());
  b.field("max_bad_message_share", c.max_bad_message_share,
          "of a topic's messages; more that do not decode are fatal", between(0, 1));
  b.check("max_range_m", c.max_range_m > c.min_range_m, "must be larger than min_range_m");
}

const char* name(Sensor sensor) { return describe(sensor).name; }
LogRole role(Sensor sensor) { return describe(sensor).role; }

std::vector<SensorTopic> sensor_topics(const Rig& rig, const LogConfig& config) {
  std::vector<SensorTopic> topics = {{Sensor::kLeft, rig.cam0.topic}};
  if (rig.cam1) topics.push_back({Sensor::kRight, rig.cam1->topic});
  if (rig.lidar0) topics.push_back({Sensor::kLidar, rig.lidar0->topic});
  for (const auto& [sensor, topic] : topics) {
    if (topic.empty()) throw ConfigError(std::string("rig: the ") + name(sensor) + " has no rostopic");
  }
  topics.push_back({Sensor::kAttitude, config.attitude_topic});
  topics.push_back({Sensor::kPosition, config.position_topic});
  if (config.height_topic) topics.push_back({Sensor::kHeight, *config.height_topic});
  return topics;
}

const Decoder& require_decoder(const SensorTopic& topic, const std::string& type, const std::string& md5) {
  const Decoder* decoder = find_decoder(role(topic.sensor), type);
  if (decoder == nullptr) {
    throw DataError("topic " + topic.topic + " (" + name(topic.sensor) + ") has type " + type +
                    "; accepted are " + accepted_types(role(topic.sensor)));
  }
  if (md5 != decoder->md5) {
    throw DataError("topic " + topic.topic + ": " + decoder->type + " of another version (checksum " + md5 +
                    ", known is " + decoder->md5 + ")");
  }
  return *decoder;
}

}  // namespace alight
