#include "sensors/stream/flight_log.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "foundation/errors.hpp"
#include "sensors/bag/bag_messages.hpp"
#include "sensors/stream/message_assembler.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

constexpr int kClouds = 10;                     // to look at before the first is read
constexpr std::int64_t kLoggedBadMessages = 3;  // a topic; the rest is only counted

/// What a connection of the bag is read for, and by what.
struct Reading {
  Sensor sensor;
  const Decoder* decoder;
};

}  // namespace

struct FlightLog::Impl {
  Impl(fs::path log, const Rig& rig_in, const LogConfig& config_in, std::vector<SensorTopic> topics_in)
      : path(std::move(log)),
        rig(rig_in),
        config(config_in),
        topics(std::move(topics_in)),
        assembler(rig_in, config_in),
        bag(path) {
    open();
  }

  void open();
  void look_ahead();
  void choose(const SensorTopic& wanted);
  void choose(const SensorTopic& found, const BagConnection& connection);
  std::string topics_present() const;

  bool read_message();
  void decode(const Reading& reading, const RawMessage& raw, const std::string& topic);
  void note_bad(const std::string& topic, std::int64_t t_ns, const std::string& reason);
  void finish();

  fs::path path;
  Rig rig;
  LogConfig config;
  std::vector<SensorTopic> topics;
  MessageAssembler assembler;
  LogSummary summary;

  BagMessages bag;
  std::map<std::string, std::vector<Reading>> readings;  // by topic
  std::map<std::string, std::string> present;            // topic -> type
  std::map<std::string, std::int64_t> bad;               // by topic
  std::int64_t consumed = 0;
  std::int64_t receive_ns = 0;
  bool finished = false;
};

void FlightLog::Impl::open() {
  if (bag.select_all() == 0) throw DataError(path.string() + ": holds no messages; record it again");
  for (const BagConnection& connection : bag.connections()) present[connection.topic] = connection.type;
  for (const SensorTopic& wanted : topics) choose(wanted);
  std::set<std::string> read;
  for (const auto& [topic, list] : readings) {
    summary.topic_messages[topic] = bag.count(topic);
    read.insert(topic);
  }
  look_ahead();
  summary.messages = bag.select(read);
  summary.begin_ns = bag.begin_ns();
  summary.end_ns = bag.end_ns();
  if (bag.lost_bytes() > 0)
    summary.dropped["bytes at the end of a bag without index"] = static_cast<std::int64_t>(bag.lost_bytes());
}

/// The first clouds of the log together tell what their points' times mean.
void FlightLog::Impl::look_ahead() {
  for (const auto& [topic, list] : readings) {
    for (const Reading& reading : list) {
      if (reading.sensor != Sensor::kLidar) continue;
      bag.select({topic});
      for (int i = 0; i < kClouds; ++i) {
        const auto message = bag.next();
        if (!message) break;
        assembler.look_ahead(*reading.decoder, message->raw);
      }
    }
  }
}

void FlightLog::Impl::choose(const SensorTopic& wanted) {
  const auto& [sensor, topic] = wanted;
  const std::string found = present.count(topic) != 0 ? topic : topic + "/compressed";
  if (present.count(found) == 0) {
    if (sensor != Sensor::kHeight) {
      throw DataError(path.string() + ": no topic " + topic + " (" + name(sensor) + ", also looked for as " +
                      topic + "/compressed); the bag has " + topics_present());
    }
    spdlog::warn("{}: no topic {} ({}); heights stay unknown", path.string(), topic, name(sensor));
    return;
  }
  std::string type;
  for (const BagConnection& connection : bag.connections()) {
    if (connection.topic != found) continue;
    if (!type.empty() && connection.type != type) {
      throw DataError(path.string() + ": topic " + found + " (" + name(sensor) +
                      ") holds messages of two types, " + type + " and " + connection.type +
                      "; record each on a topic of its own");
    }
    type = connection.type;
    choose({sensor, found}, connection);
  }
}

void FlightLog::Impl::choose(const SensorTopic& found, const BagConnection& connection) {
  const Decoder* decoder = nullptr;
  try {
    decoder = &require_decoder(found, connection.type, connection.md5);
  } catch (const DataError& e) {
    throw DataError(path.string() + ": " + e.what());
  }
  auto& list = readings[found.topic];
  const bool known =
      std::any_of(list.begin(), list.end(), [&](const Reading& r) { return r.sensor == found.sensor; });
  if (!known) list.push_back({found.sensor, decoder});
}

std::string FlightLog::Impl::topics_present() const {
  std::string text;
  for (const auto& [topic, type] : present) text += (text.empty() ? "" : ", ") + topic + " (" + type + ")";
  return text;
}

bool FlightLog::Impl::read_message() {
  const std::optional<BagMessage> message = bag.next();
  if (!message) {
    finish();
    return false;
  }
  receive_ns = message->raw.receive_ns;
  const std::string& topic = message->connection->topic;
  for (const Reading& reading : readings.at(topic)) decode(reading, message->raw, topic);
  ++consumed;
  return true;
}

void FlightLog::Impl::decode(const Reading& reading, const RawMessage& raw, const std::string& topic) {
  try {
    assembler.add(reading.sensor, *reading.decoder, raw);
  } catch (const DecodeError& e) {
    note_bad(topic, raw.receive_ns, e.what());
  }
  for (const auto& [reason, count] : assembler.dropped()) summary.dropped[reason] = count;
  if (const auto lead_ns = assembler.constant_lead_ns()) {
    throw DataError(
        fmt::format("{}: the right images' stamps are {:.1f} ms after the left ones', too far for a pair. "
                    "Cameras that are triggered "
                    "together: set log.right_stamp_lead_s: {:.4f}; cameras that are not cannot be used "
                    "together (or, hovering, with "
                    "log.stereo_pair_tolerance_s: {:.4f})",
                    path.string(), 1e3 * to_seconds(*lead_ns), to_seconds(*lead_ns),
                    std::abs(to_seconds(*lead_ns)) + 0.002));
  }
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
  const std::int64_t unpaired = assembler.unpaired() + assembler.waiting();
  if (unpaired > 0) summary.dropped["images without the other camera's"] = unpaired;
}

FlightLog::FlightLog(const fs::path& path, const Rig& rig, const LogConfig& config)
    : FlightLog(path, rig, config, sensor_topics(rig, config)) {}
FlightLog::FlightLog(const fs::path& path, const Rig& rig, const LogConfig& config,
                     const std::vector<SensorTopic>& topics)
    : impl_(std::make_unique<Impl>(path, rig, config, topics)) {}
FlightLog::~FlightLog() = default;
FlightLog::FlightLog(FlightLog&&) noexcept = default;
FlightLog& FlightLog::operator=(FlightLog&&) noexcept = default;

bool FlightLog::next(LogMessage& out) {
  std::optional<LogMessage> message;
  while (!(message = impl_->assembler.take())) {
    if (!impl_->read_message()) return false;
  }
  out = std::move(*message);
  return true;
}

void FlightLog::keep_every_nth_image(int n) { impl_->assembler.keep_every_nth_image(n); }
void FlightLog::put_off_decoding() { impl_->assembler.put_off_decoding(); }
void FlightLog::decode(StereoFrame& frame) const { impl_->assembler.decode(frame); }
std::int64_t FlightLog::receive_ns() const { return impl_->receive_ns; }
std::int64_t FlightLog::consumed() const { return impl_->consumed; }
const LogSummary& FlightLog::summary() const { return impl_->summary; }

}  // namespace alight
