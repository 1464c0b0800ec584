#include "closed_loop/landing/message_feed.hpp"

#include <cstdint>

#include <ros/message_traits.h>
#include <ros/serialization.h>

namespace alight::closed_loop {

MessageFeed::MessageFeed(const Rig& rig, const LogConfig& config) : assembler_(rig, config) {
  for (const SensorTopic& topic : sensor_topics(rig, config)) {
    sensors_[topic.topic] = topic.sensor;
    sensors_[topic.topic + "/compressed"] = topic.sensor;
  }
}

std::vector<LogMessage> MessageFeed::add(const sim::RecordedMessage& message) {
  const auto sensor = sensors_.find(message.topic);
  if (sensor == sensors_.end()) return {};
  std::visit(
      [&](const auto& content) {
        using Message = std::decay_t<decltype(content)>;
        std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(content));
        ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
        ros::serialization::serialize(stream, content);
        const Decoder& decoder =
            require_decoder({sensor->second, message.topic}, ros::message_traits::DataType<Message>::value(),
                            ros::message_traits::MD5Sum<Message>::value());
        assembler_.add(sensor->second, decoder, {bytes.data(), bytes.size(), message.receive_ns});
      },
      message.content);
  std::vector<LogMessage> complete;
  while (auto next = assembler_.take()) complete.push_back(std::move(*next));
  return complete;
}

}  // namespace alight::closed_loop
