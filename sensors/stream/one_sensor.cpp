#include "sensors/stream/one_sensor.hpp"

#include "sensors/messages/byte_reader.hpp"

namespace alight {

bool OneSensor::wanted(const LidarPacket& packet) {
  if (lidar_id_ && packet.lidar_id) return *lidar_id_ == *packet.lidar_id;
  if (!first_frame_) {
    first_id_ = packet.lidar_id;
    first_frame_ = packet.frame_id;
  }
  if (packet.lidar_id && packet.lidar_id != first_id_) {
    throw DecodeError("lidar_id " + std::to_string(*packet.lidar_id) + " among messages of lidar_id " +
                      std::to_string(first_id_.value_or(-1)) +
                      ": two LiDARs on one topic; set lidar_id of the rig's lidar0 to the calibrated one");
  }
  if (packet.frame_id != *first_frame_) {
    throw DecodeError("frame_id \"" + packet.frame_id + "\" among messages of \"" + *first_frame_ +
                      "\": two LiDARs on one topic, whose points have different places; record each on a "
                      "topic of its own");
  }
  return true;
}

}  // namespace alight
