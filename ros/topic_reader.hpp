#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <topic_tools/shape_shifter.h>

#include "infer/onboard/steady_time.hpp"
#include "sensors/stream/log_config.hpp"
#include "sensors/stream/message_assembler.hpp"

namespace alight {

/// How a topic is doing.
struct TopicState {
  std::string topic;  ///< where its messages come from, or are expected
  std::string sensors;
  std::int64_t messages = 0;
  bool silent = false;  ///< for kSilence_s
  bool published = false;
  std::string problem;  ///< why its messages cannot be read; empty: they can
};

/// Subscribes to what a log would hold (FlightLog) and hands the very bytes to the same decoders. An image comes from
/// the topic that the rig names or from the same with `/compressed` appended: the first that delivers is kept. A type
/// without a stamp gets the time of its arrival, which is the simulated one under /use_sim_time. All on the thread that
/// serves ROS's callbacks.
class TopicReader {
 public:
  static constexpr double kSilence_s = 5;
  using Receive = std::function<void(LogMessage)>;

  /// @throws ConfigError as sensor_topics
  TopicReader(ros::NodeHandle node, const Rig& rig, const LogConfig& config, Receive receive);
  TopicReader(const TopicReader&) = delete;
  TopicReader& operator=(const TopicReader&) = delete;

  /// Forgets the images that wait for their other camera: the time has jumped.
  void restart();

  std::vector<TopicState> topics() const;
  /// What was left out, since the last restart: reason -> count.
  std::map<std::string, std::int64_t> dropped() const;

 private:
  using Event = ros::MessageEvent<topic_tools::ShapeShifter const>;
  struct Reading {
    Sensor sensor;
    const Decoder* decoder;
  };
  struct Input {
    std::string topic;
    std::vector<Sensor> sensors;
    std::vector<ros::Subscriber> subscribers;  // one once messages come
    std::string delivering;                    // the topic that messages come from; empty: none yet
    std::string type;                          // of the messages, with checksum
    std::vector<Reading> readings;
    std::string problem;
    std::int64_t messages = 0;
    SteadyTime last = steady_now();
  };

  void subscribe(Input& input);
  void take(Input& input, const std::string& topic, const Event& event);
  void choose_decoders(Input& input, const topic_tools::ShapeShifter& message);

  ros::NodeHandle node_;
  Rig rig_;
  LogConfig config_;
  Receive receive_;
  MessageAssembler assembler_;
  std::deque<Input> inputs_;  // callbacks hold references
  std::int64_t bad_ = 0;
};

}  // namespace alight
