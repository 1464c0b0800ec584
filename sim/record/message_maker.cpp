#include "sim/record/message_maker.hpp"

#include "geometry/frames.hpp"

namespace alight::sim {

std::int64_t MessageMaker::on_clock(const ScheduledMessage& message, double clock_offset_s) const {
  return sensors_.start_time_s * kNanosecondsPerSecond + message.measured_ns + to_nanoseconds(clock_offset_s);
}

RecordedMessage MessageMaker::recorded(std::string topic, const ScheduledMessage& message,
                                       RecordedMessage::Content content) const {
  return {std::move(topic), sensors_.start_time_s * kNanosecondsPerSecond + message.receive_ns,
          std::move(content)};
}

RecordedMessage MessageMaker::pose(const PoseSensors& sensor, const ScheduledMessage& message) const {
  const std::int64_t stamp_ns = on_clock(message, sensors_.pose_clock_offset_s);
  const auto sequence = static_cast<std::uint32_t>(message.index);
  switch (message.stream) {
    case SensorStream::kAttitude:
      return recorded(kAttitudeTopic, message,
                      attitude_message(sensor.attitude(message.index), stamp_ns, sequence));
    case SensorStream::kImu:
      return recorded(kImuTopic, message, imu_message(sensor.imu(message.index), stamp_ns, sequence));
    case SensorStream::kPosition:
      return recorded(kPositionTopic, message,
                      position_message(sensor.position(message.index), stamp_ns, sequence));
    default:
      return recorded(kHeightTopic, message, height_message(sensor.height_m(message.index)));
  }
}

RecordedMessage MessageMaker::lidar(const LidarSensor& sensor, const ScheduledMessage& message) const {
  return recorded(rig_.lidar0->topic, message,
                  lidar_message(sensor.scan(message.index), on_clock(message, sensors_.lidar.clock_offset_s),
                                static_cast<std::uint32_t>(message.index)));
}

std::int64_t MessageMaker::image_stamp_ns(const ScheduledMessage& message) const {
  return on_clock(message, sensors_.camera.clock_offset_s);
}

RecordedMessage MessageMaker::image(const std::string& topic, const std::string& frame,
                                    const ScheduledMessage& message, const cv::Mat& pixels) const {
  const auto sequence = static_cast<std::uint32_t>(message.index);
  const std::int64_t stamp_ns = image_stamp_ns(message);
  if (sensors_.camera.format == ImageFormat::kRaw) {
    return recorded(topic, message, image_message(pixels, frame, stamp_ns, sequence));
  }
  return recorded(topic + "/compressed", message,
                  jpeg_message(pixels, sensors_.camera.jpeg_quality, frame, stamp_ns, sequence));
}

std::pair<RecordedMessage, RecordedMessage> MessageMaker::images(const StereoExposure& exposure,
                                                                 const ScheduledMessage& message) const {
  return {image(rig_.cam0.topic, "mynteye_left", message, exposure.left),
          image(rig_.cam1->topic, "mynteye_right", message, exposure.right)};
}

}  // namespace alight::sim
