#include "dataset/inspect_command.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <ctime>
#include <string>

#include "dataset/inspect/bag_inspection.hpp"
#include "dataset/inspect/rig_suggestion.hpp"
#include "foundation/command_line.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr std::size_t kShownFrames = 12;

/// Names out of a damaged bag may hold anything; a terminal would obey it.
std::string printable(std::string text) {
  for (char& c : text) {
    if (std::isprint(static_cast<unsigned char>(c)) == 0) c = '?';
  }
  return text;
}

std::string utc(std::int64_t t_ns) {
  const std::time_t seconds = t_ns / kNanosecondsPerSecond;
  std::tm time{};
  gmtime_r(&seconds, &time);
  char text[40];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S UTC", &time);
  return text;
}

/// "camera, intrinsics"; else why it serves as nothing.
std::string use_of(const TopicReport& topic) {
  if (!topic.known_type) return "- (unknown type, skipped)";
  if (!topic.known_version) return "- (checksum " + printable(topic.md5) + " is of another version, skipped)";
  std::string roles;
  for (const RoleTrial& trial : topic.roles) {
    if (trial.measurements > 0) roles += (roles.empty() ? "" : ", ") + std::string(name(trial.role));
  }
  if (!roles.empty()) return roles;
  return topic.messages == 0 ? "- (no messages)" : "- (holds no measurement)";
}

void print_offset(const TopicReport& topic) {
  if (!topic.offset) return;
  std::printf("    received %+.4f s after the stamp (median; %+.4f .. %+.4f)\n", topic.offset->median_s,
              topic.offset->min_s, topic.offset->max_s);
}

void print_gaps(const TopicReport& topic, std::int64_t begin_ns) {
  if (topic.gaps == 0) return;
  std::printf("    %lld gaps longer than three times the median, the longest %.3f s at %.3f s\n",
              static_cast<long long>(topic.gaps), topic.longest_gap_s,
              to_seconds(topic.longest_gap_ns - begin_ns));
}

void print_trials(const TopicReport& topic) {
  for (const RoleTrial& trial : topic.roles) {
    if (trial.example) std::printf("    %s: %s\n", name(trial.role), describe(*trial.example).c_str());
    if (trial.measurements < trial.tried) {
      std::printf("    %s: %d of the first %d messages hold no measurement%s%s\n", name(trial.role),
                  trial.tried - trial.measurements, trial.tried, trial.first_problem.empty() ? "" : ": ",
                  printable(trial.first_problem).c_str());
    }
  }
}

void print_frames(const TopicReport& topic) {
  std::size_t shown = 0;
  for (const auto& [parent, child] : topic.frames) {
    if (shown++ == kShownFrames) {
      std::printf("    and %zu more\n", topic.frames.size() - kShownFrames);
      return;
    }
    std::printf("    transform: %s -> %s\n", printable(parent).c_str(), printable(child).c_str());
  }
}

void print_report(const BagReport& report) {
  std::printf("%s: %lld messages on %zu topics", report.path.c_str(), static_cast<long long>(report.messages),
              report.topics.size());
  if (report.messages > 0)
    std::printf(", %.3f s from %s", to_seconds(report.end_ns - report.begin_ns),
                utc(report.begin_ns).c_str());
  std::size_t topic_width = 5;
  std::size_t type_width = 4;
  for (const TopicReport& topic : report.topics) {
    topic_width = std::max(topic_width, topic.topic.size());
    type_width = std::max(type_width, topic.type.size());
  }
  std::printf("\n\n%-*s  %-*s  %8s  %9s  %9s  %7s  serves as\n", static_cast<int>(topic_width), "topic",
              static_cast<int>(type_width), "type", "messages", "rate_hz", "span_s", "gap_s");
  for (const TopicReport& topic : report.topics) {
    std::printf("%-*s  %-*s  %8lld  %9.2f  %9.2f  %7.3f  %s\n", static_cast<int>(topic_width),
                printable(topic.topic).c_str(), static_cast<int>(type_width), printable(topic.type).c_str(),
                static_cast<long long>(topic.messages), topic.rate_hz(),
                to_seconds(topic.last_ns - topic.first_ns), topic.longest_gap_s, use_of(topic).c_str());
    print_offset(topic);
    print_gaps(topic, report.begin_ns);
    print_trials(topic);
    print_frames(topic);
  }
  if (report.lost_bytes > 0)
    std::printf("the last %llu bytes cannot be read: the recorder was killed\n",
                static_cast<unsigned long long>(report.lost_bytes));
  for (const auto& [topic, count] : report.without_time) {
    std::printf("%s: %lld more messages that cannot be read: their receive time is zero\n",
                printable(topic).c_str(), static_cast<long long>(count));
  }
}

}  // namespace

int run_inspect(const std::filesystem::path& bag) {
  const BagReport report = inspect_bag(bag);
  print_report(report);
  const std::string suggestion = suggest_configuration(report);
  if (!suggestion.empty()) std::fputs(("\n" + suggestion).c_str(), stdout);
  return kExitOk;
}

}  // namespace alight
