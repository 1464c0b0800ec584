#include "dataset/flight_log.hpp"

#include <algorithm>
#include <deque>
#include <utility>
#include <vector>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <spdlog/spdlog.h>

#include "configs/errors.hpp"
#include "dataset/bag_access.hpp"
#include "dataset/bag_check.hpp"
#include "dataset/messages/decoders.hpp"
#include "dataset/stereo_pairing.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t kLoggedBadMessages = 3;  // a topic; the rest is only counted

/// What a topic is read for; unlike a LogRole it tells left from right.
enum class Sensor { kLeft, kRight, kLidar, kAttitude, kPosition, kHeight };

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

/// What a connection of the bag is read for, and by what.
struct Reading {
  Sensor sensor;
  const Decoder* decoder;
};

std::int64_t nanoseconds(const ros::Time& time) { return static_cast<std::int64_t>(time.toNSec()); }

}  // namespace

void bind(Binder& b, LogConfig& c) {
  b.field("attitude_topic", c.attitude_topic,
          "attitude of the vehicle: " + accepted_types(LogRole::kAttitude));
  b.field("position_topic", c.position_topic,
          "position of the vehicle: " + accepted_types(LogRole::kPosition));
  b.field("height_topic", c.height_topic,
          "height above take-off, or none: " + accepted_types(LogRole::kHeight));
  b.field("stereo_pair_tolerance_s", c.stereo_pair_tolerance_s,
          "left and right of one exposure differ by no more", at_least(0));
  b.field("min_range_m", c.min_range_m, "LiDAR returns nearer than this are dropped", at_least(0));
  b.field("max_range_m", c.max_range_m, "LiDAR returns farther than this are dropped", positive());
  b.field("max_bad_message_share", c.max_bad_message_share,
          "of a topic's messages; more that do not decode are fatal", between(0, 1));
  b.check("max_range_m", c.max_range_m > c.min_range_m, "must be larger than min_range_m");
}

struct FlightLog::Impl {
  Impl(fs::path log, const Rig& rig_in, const LogConfig& config_in)
      : path(std::move(log)),
        rig(rig_in),
        config(config_in),
        options{config_in.min_range_m, config_in.max_range_m},
        pairer(to_nanoseconds(config_in.stereo_pair_tolerance_s)) {
    require_file(path);
    check_bag_structure(path);
    with_bag_errors(path, [&] { open(); });
  }

  void open();
  std::vector<std::pair<Sensor, std::string>> wanted_topics() const;
  void choose(Sensor sensor, const std::string& topic,
              const std::vector<const rosbag::ConnectionInfo*>& connections);
  std::string topics_present() const;
  void count_messages();

  bool read_message();
  void decode(const Reading& reading, const RawMessage& raw, const std::string& topic);
  void take(Sensor sensor, DecodedMessage decoded);
  void take_image(Sensor sensor, CameraImage image);
  void note_bad(const std::string& topic, std::int64_t t_ns, const std::string& reason);
  void finish();

  fs::path path;
  Rig rig;
  LogConfig config;
  DecodeOptions options;
  StereoPairer pairer;
  LogSummary summary;

  rosbag::Bag bag;
  std::unique_ptr<rosbag::View> view;
  rosbag::View::iterator at;
  std::map<std::string, std::vector<Reading>> readings;  // by topic
  std::map<std::string, std::string> present;            // topic -> type
  std::map<std::string, std::int64_t> bad;               // by topic
  std::deque<LogMessage> ready;
  ByteSink sink;
  std::int64_t consumed = 0;
  std::int64_t receive_ns = 0;
  bool finished = false;
};

void FlightLog::Impl::open() {
  bag.open(path.string(), rosbag::bagmode::Read);
  rosbag::View all(bag);
  const auto connections = all.getConnections();
  for (const rosbag::ConnectionInfo* connection : connections)
    present[connection->topic] = connection->datatype;
  if (all.size() == 0) throw DataError(path.string() + ": holds no messages; record it again");
  for (const auto& [sensor, topic] : wanted_topics()) choose(sensor, topic, connections);
  count_messages();
  view = std::make_unique<rosbag::View>(bag, [this](const rosbag::ConnectionInfo* connection) {
    return readings.count(connection->topic) != 0;
  });
  summary.messages = view->size();
  summary.begin_ns = nanoseconds(view->getBeginTime());
  summary.end_ns = nanoseconds(view->getEndTime());
  at = view->begin();
}

std::vector<std::pair<Sensor, std::string>> FlightLog::Impl::wanted_topics() const {
  std::vector<std::pair<Sensor, std::string>> topics = {{Sensor::kLeft, rig.cam0.topic}};
  if (rig.cam1) topics.emplace_back(Sensor::kRight, rig.cam1->topic);
  if (rig.lidar0) topics.emplace_back(Sensor::kLidar, rig.lidar0->topic);
  for (const auto& [sensor, topic] : topics) {
    if (topic.empty())
      throw ConfigError(std::string("rig: the ") + describe(sensor).name + " has no rostopic");
  }
  topics.emplace_back(Sensor::kAttitude, config.attitude_topic);
  topics.emplace_back(Sensor::kPosition, config.position_topic);
  if (config.height_topic) topics.emplace_back(Sensor::kHeight, *config.height_topic);
  return topics;
}

void FlightLog::Impl::choose(Sensor sensor, const std::string& topic,
                             const std::vector<const rosbag::ConnectionInfo*>& connections) {
  const SensorName wanted = describe(sensor);
  const std::string found = present.count(topic) != 0 ? topic : topic + "/compressed";
  if (present.count(found) == 0) {
    if (sensor != Sensor::kHeight) {
      throw DataError(path.string() + ": no topic " + topic + " (" + wanted.name + ", also looked for as " +
                      topic + "/compressed); the bag has " + topics_present());
    }
    spdlog::warn("{}: no topic {} ({}); heights stay unknown", path.string(), topic, wanted.name);
    return;
  }
  for (const rosbag::ConnectionInfo* connection : connections) {
    if (connection->topic != found) continue;
    const Decoder* decoder = find_decoder(wanted.role, connection->datatype);
    if (decoder == nullptr) {
      throw DataError(path.string() + ": topic " + found + " (" + wanted.name + ") has type " +
                      connection->datatype + "; accepted are " + accepted_types(wanted.role));
    }
    if (connection->md5sum != decoder->md5) {
      throw DataError(path.string() + ": topic " + found + ": " + decoder->type +
                      " of another version (checksum " + connection->md5sum + ", known is " + decoder->md5 +
                      ")");
    }
    auto& list = readings[found];
    const bool known =
        std::any_of(list.begin(), list.end(), [&](const Reading& r) { return r.sensor == sensor; });
    if (!known) list.push_back({sensor, decoder});
  }
}

std::string FlightLog::Impl::topics_present() const {
  std::string text;
  for (const auto& [topic, type] : present) text += (text.empty() ? "" : ", ") + topic + " (" + type + ")";
  return text;
}

void FlightLog::Impl::count_messages() {
  for (const auto& [topic, list] : readings) {
    rosbag::View one(bag, rosbag::TopicQuery(topic));
    summary.topic_messages[topic] = one.size();
  }
}

bool FlightLog::Impl::read_message() {
  if (at == view->end()) {
    finish();
    return false;
  }
  const rosbag::MessageInstance& message = *at;
  sink.bytes.clear();
  message.write(sink);
  receive_ns = nanoseconds(message.getTime());
  const RawMessage raw{sink.bytes.data(), sink.bytes.size(), receive_ns};
  for (const Reading& reading : readings.at(message.getTopic())) decode(reading, raw, message.getTopic());
  ++consumed;
  ++at;
  return true;
}

void FlightLog::Impl::decode(const Reading& reading, const RawMessage& raw, const std::string& topic) {
  std::optional<DecodedMessage> decoded;
  try {
    decoded = reading.decoder->decode(raw, options);
    if (const auto* image = decoded ? std::get_if<CameraImage>(&*decoded) : nullptr) {
      const cv::Size wanted = rig.cam0.camera.intrinsics.size();
      if (image->image.size() != wanted) {
        throw DecodeError("image of " + std::to_string(image->image.cols) + "x" +
                          std::to_string(image->image.rows) + " pixels, but the rig's camera has " +
                          std::to_string(wanted.width) + "x" + std::to_string(wanted.height));
      }
    }
  } catch (const DecodeError& e) {
    return note_bad(topic, raw.receive_ns, e.what());
  }
  if (!decoded) {
    ++summary.dropped[std::string(describe(reading.sensor).name) + " messages without a measurement"];
    return;
  }
  take(reading.sensor, std::move(*decoded));
}

void FlightLog::Impl::take(Sensor sensor, DecodedMessage decoded) {
  if (auto* image = std::get_if<CameraImage>(&decoded)) return take_image(sensor, std::move(*image));
  if (auto* packet = std::get_if<LidarPacket>(&decoded)) {
    const std::int64_t shift_ns = to_nanoseconds(rig.lidar0->timeshift_s);
    packet->t_ns += shift_ns;
    for (LidarReturn& point : packet->returns) point.t_ns += shift_ns;
    if (packet->dropped > 0) summary.dropped["LiDAR points without echo or out of range"] += packet->dropped;
    ready.emplace_back(std::move(*packet));
  } else if (auto* attitude = std::get_if<AttitudeSample>(&decoded)) {
    ready.emplace_back(*attitude);
  } else if (auto* position = std::get_if<PositionSample>(&decoded)) {
    ready.emplace_back(*position);
  } else {
    ready.emplace_back(std::get<HeightSample>(decoded));
  }
}

/// The eyes are triggered together, so they are paired by the stamps as recorded; the frame's time is the
/// left eye's.
void FlightLog::Impl::take_image(Sensor sensor, CameraImage image) {
  std::optional<StereoFrame> frame;
  if (!rig.cam1) {
    frame = StereoFrame{image.t_ns, std::move(image.image), {}};
  } else {
    frame = sensor == Sensor::kLeft ? pairer.add_left(std::move(image)) : pairer.add_right(std::move(image));
  }
  if (!frame) return;
  frame->t_ns += to_nanoseconds(rig.cam0.timeshift_cam_imu_s);
  ready.emplace_back(std::move(*frame));
}

void FlightLog::Impl::note_bad(const std::string& topic, std::int64_t t_ns, const std::string& reason) {
  const std::int64_t count = ++bad[topic];
  ++summary.dropped["messages that do not decode"];
  const double after_s = to_seconds(t_ns - summary.begin_ns);
  if (count <= kLoggedBadMessages) {
    spdlog::warn("{}: topic {}: message at {:.3f} s skipped: {}", path.string(), topic, after_s, reason);
  }
  const std::int64_t total = summary.topic_messages.at(topic);
  if (static_cast<double>(count) > config.max_bad_message_share * static_cast<double>(total)) {
    throw DataError(path.string() + ": topic " + topic + ": " + std::to_string(count) + " of " +
                    std::to_string(total) +
                    " messages do not decode, more than max_bad_message_share allows; the last at " +
                    std::to_string(after_s) + " s: " + reason);
  }
}

void FlightLog::Impl::finish() {
  if (finished) return;
  finished = true;
  const std::int64_t unpaired = pairer.unpaired() + pairer.waiting();
  if (unpaired > 0) summary.dropped["images without the other eye's"] = unpaired;
}

FlightLog::FlightLog(const fs::path& path, const Rig& rig, const LogConfig& config)
    : impl_(std::make_unique<Impl>(path, rig, config)) {}
FlightLog::~FlightLog() = default;
FlightLog::FlightLog(FlightLog&&) noexcept = default;
FlightLog& FlightLog::operator=(FlightLog&&) noexcept = default;

bool FlightLog::next(LogMessage& out) {
  return with_bag_errors(impl_->path, [&] {
    while (impl_->ready.empty()) {
      if (!impl_->read_message()) return false;
    }
    out = std::move(impl_->ready.front());
    impl_->ready.pop_front();
    return true;
  });
}

std::int64_t FlightLog::receive_ns() const { return impl_->receive_ns; }
std::int64_t FlightLog::consumed() const { return impl_->consumed; }
const LogSummary& FlightLog::summary() const { return impl_->summary; }

}  // namespace alight
