#include "ros/topic_reader.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <ros/console.h>

#include "foundation/errors.hpp"
#include "sensors/bag/bag_access.hpp"

namespace alight {
namespace {

// What may wait for this thread: an image is large and soon out of date, the rest is small.
constexpr std::uint32_t kReceivedImages = 10;
constexpr std::uint32_t kReceivedOthers = 1000;

}  // namespace

TopicReader::TopicReader(ros::NodeHandle node, const Rig& rig, const LogConfig& config, Receive receive)
    : node_(std::move(node)),
      rig_(rig),
      config_(config),
      receive_(std::move(receive)),
      assembler_(rig, config) {
  for (const auto& [sensor, topic] : sensor_topics(rig, config)) {
    const auto known = std::find_if(inputs_.begin(), inputs_.end(),
                                    [&name = topic](const Input& input) { return input.topic == name; });
    Input& input = known != inputs_.end() ? *known : inputs_.emplace_back();
    input.topic = topic;
    input.sensors.push_back(sensor);
  }
  for (Input& input : inputs_) subscribe(input);
}

void TopicReader::subscribe(Input& input) {
  const bool image = role(input.sensors.front()) == LogRole::kImage;
  std::vector<std::string> topics = {input.topic};
  if (image) topics.push_back(input.topic + "/compressed");
  for (const std::string& topic : topics) {
    const boost::function<void(const Event&)> callback = [this, &input, topic](const Event& event) {
      take(input, topic, event);
    };
    input.subscribers.push_back(
        node_.subscribe<topic_tools::ShapeShifter>(topic, image ? kReceivedImages : kReceivedOthers, callback,
                                                   ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
  }
}

void TopicReader::take(Input& input, const std::string& topic, const Event& event) {
  if (input.delivering.empty()) {
    input.delivering = topic;
    const std::string resolved = node_.resolveName(topic);
    input.subscribers.erase(
        std::remove_if(input.subscribers.begin(), input.subscribers.end(),
                       [&](const ros::Subscriber& other) { return other.getTopic() != resolved; }),
        input.subscribers.end());
  }
  if (input.delivering != topic) return;  // it was under way when the other one was chosen
  ++input.messages;
  input.last = steady_now();
  choose_decoders(input, *event.getMessage());
  ByteSink sink;
  event.getMessage()->write(sink);
  const RawMessage raw{sink.bytes.data(), sink.bytes.size(),
                       static_cast<std::int64_t>(event.getReceiptTime().toNSec())};
  for (const Reading& reading : input.readings) {
    try {
      assembler_.add(reading.sensor, *reading.decoder, raw);
    } catch (const DecodeError& e) {
      ++bad_;
      ROS_WARN_THROTTLE(10, "topic %s: message skipped: %s", topic.c_str(), e.what());
    }
  }
  while (std::optional<LogMessage> message = assembler_.take()) receive_(std::move(*message));
}

void TopicReader::choose_decoders(Input& input, const topic_tools::ShapeShifter& message) {
  const std::string type = message.getDataType() + " " + message.getMD5Sum();
  if (type == input.type) return;
  input.type = type;
  input.readings.clear();
  input.problem.clear();
  try {
    for (const Sensor sensor : input.sensors) {
      const SensorTopic topic{sensor, input.delivering};
      input.readings.push_back({sensor, &require_decoder(topic, message.getDataType(), message.getMD5Sum())});
    }
  } catch (const DataError& e) {
    input.problem = e.what();
    ROS_ERROR("%s; its messages are left out", e.what());
  }
}

void TopicReader::restart() {
  assembler_ = MessageAssembler(rig_, config_);
  bad_ = 0;
}

std::vector<TopicState> TopicReader::topics() const {
  std::vector<TopicState> states;
  for (const Input& input : inputs_) {
    TopicState state;
    state.topic = node_.resolveName(input.delivering.empty() ? input.topic : input.delivering);
    for (const Sensor sensor : input.sensors)
      state.sensors += (state.sensors.empty() ? "" : ", ") + std::string(name(sensor));
    state.messages = input.messages;
    state.silent = milliseconds(input.last, steady_now()) > kSilence_s * 1e3;
    for (const ros::Subscriber& subscriber : input.subscribers)
      state.published = state.published || subscriber.getNumPublishers() > 0;
    state.problem = input.problem;
    states.push_back(std::move(state));
  }
  return states;
}

std::map<std::string, std::int64_t> TopicReader::dropped() const {
  std::map<std::string, std::int64_t> dropped = assembler_.dropped();
  if (bad_ > 0) dropped["messages that do not decode"] = bad_;
  if (assembler_.unpaired() > 0) dropped["images without the other camera's"] = assembler_.unpaired();
  return dropped;
}

}  // namespace alight
