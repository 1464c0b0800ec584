#include "dataset/inspect/bag_inspection.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <sstream>
#include <utility>

#include "foundation/order_statistics.hpp"
#include "geometry/frames.hpp"
#include "sensors/bag/bag_index.hpp"
#include "sensors/bag/bag_messages.hpp"
#include "sensors/messages/pose_decoders.hpp"

namespace alight {
namespace {

constexpr int kTriedMessages = 20;  // a topic and role; decoding pictures is slow

/// True if the first field of a message definition is a std_msgs/Header.
bool begins_with_header(const std::string& definition) {
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string type;
    std::string name;
    if (!(words >> type)) continue;
    words >> name;
    const bool constant = name.find('=') != std::string::npos || line.find('=') != std::string::npos;
    if (constant) continue;
    return type == "Header" || type == "std_msgs/Header" || type == "roslib/Header";
  }
  return false;
}

StampDelay summarize(std::vector<double> offsets_s) {
  const auto [min, max] = std::minmax_element(offsets_s.begin(), offsets_s.end());
  const double min_s = *min;
  const double max_s = *max;
  return {median(offsets_s), min_s, max_s};
}

/// One topic while the bag is read.
class TopicInspection {
 public:
  explicit TopicInspection(const BagConnection& connection)
      : has_header_(begins_with_header(connection.definition)) {
    report_.topic = connection.topic;
    report_.type = connection.type;
    report_.md5 = connection.md5;
    for (const Decoder& decoder : decoders()) {
      if (decoder.type != report_.type) continue;
      report_.known_type = true;
      if (decoder.md5 != report_.md5) continue;
      report_.known_version = true;
      decoders_.push_back(&decoder);
      report_.roles.emplace_back().role = decoder.role;
    }
  }

  void add(const RawMessage& raw) {
    const std::int64_t t_ns = raw.receive_ns;
    if (report_.messages == 0) report_.first_ns = t_ns;
    if (report_.messages > 0) add_gap(t_ns);
    report_.last_ns = t_ns;
    ++report_.messages;
    if (!has_header_ && decoders_.empty()) return;
    if (has_header_) add_stamp(raw);
    for (std::size_t i = 0; i < decoders_.size(); ++i) try_role(raw, *decoders_[i], report_.roles[i]);
  }

  TopicReport finish() {
    if (!offsets_s_.empty()) report_.offset = summarize(std::move(offsets_s_));
    if (!gaps_s_.empty()) {
      const double limit_s = 3 * summarize(gaps_s_).median_s;
      report_.gaps =
          std::count_if(gaps_s_.begin(), gaps_s_.end(), [&](double gap_s) { return gap_s > limit_s; });
    }
    return std::move(report_);
  }

 private:
  void add_gap(std::int64_t t_ns) {
    gaps_s_.push_back(to_seconds(t_ns - report_.last_ns));
    if (gaps_s_.back() <= report_.longest_gap_s) return;
    report_.longest_gap_s = gaps_s_.back();
    report_.longest_gap_ns = report_.last_ns;
  }

  void add_stamp(const RawMessage& raw) {
    try {
      offsets_s_.push_back(to_seconds(raw.receive_ns - ByteReader(raw).read_header().stamp_ns));
    } catch (const DecodeError&) {
      // The role's decoder says so, where there is one.
    }
  }

  void try_role(const RawMessage& raw, const Decoder& decoder, RoleTrial& trial) {
    const bool transforms = is_transform_tree(decoder);
    if (!transforms && trial.tried >= kTriedMessages) return;
    ++trial.tried;
    try {
      if (transforms) {
        for (auto& pair : transform_frames(raw)) report_.frames.insert(std::move(pair));
        ++trial.measurements;
        return;
      }
      std::optional<DecodedMessage> decoded = decode(raw, decoder, trial);
      if (!decoded) return;
      ++trial.measurements;
      if (!trial.example) trial.example = std::move(decoded);
    } catch (const DecodeError& e) {
      if (trial.first_problem.empty()) trial.first_problem = e.what();
    }
  }

  /// A cloud whose points have no time decodes once the scan's period is told.
  static std::optional<DecodedMessage> decode(const RawMessage& raw, const Decoder& decoder,
                                              RoleTrial& trial) {
    DecodeOptions options;
    if (decoder.role != LogRole::kLidar) return decoder.decode(raw, options);
    try {
      return decoder.decode(raw, options);
    } catch (const DecodeError&) {
      options.points.scan_period_s = 0;
      std::optional<DecodedMessage> decoded = decoder.decode(raw, options);
      trial.needs_scan_period = true;
      return decoded;
    }
  }

  TopicReport report_;
  bool has_header_;
  std::vector<const Decoder*> decoders_;
  std::vector<double> offsets_s_;
  std::vector<double> gaps_s_;
};

}  // namespace

double TopicReport::rate_hz() const {
  return last_ns > first_ns ? static_cast<double>(messages - 1) / to_seconds(last_ns - first_ns) : 0;
}

const RoleTrial* TopicReport::serves_as(LogRole role) const {
  for (const RoleTrial& trial : roles) {
    if (trial.role == role && trial.measurements > 0) return &trial;
  }
  return nullptr;
}

BagReport inspect_bag(const std::filesystem::path& path) {
  using Key = std::pair<std::string, std::string>;  // topic, checksum
  BagMessages bag(path);
  BagReport report;
  report.path = path;
  report.lost_bytes = bag.lost_bytes();
  std::map<Key, TopicInspection> readers;
  for (const BagConnection& c : bag.connections()) readers.try_emplace({c.topic, c.md5}, c);
  report.messages = bag.select_all();
  report.begin_ns = bag.begin_ns();
  report.end_ns = bag.end_ns();
  while (const auto message = bag.next())
    readers.at({message->connection->topic, message->connection->md5}).add(message->raw);
  report.without_time = indexed_messages(path);
  for (auto& [key, reader] : readers) {
    report.topics.push_back(reader.finish());
    const auto indexed = report.without_time.find(report.topics.back().topic);
    if (indexed != report.without_time.end()) indexed->second -= report.topics.back().messages;
  }
  for (auto at = report.without_time.begin(); at != report.without_time.end();)
    at = at->second > 0 ? std::next(at) : report.without_time.erase(at);
  return report;
}

}  // namespace alight
