#include "infer/health/stream_watch.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "foundation/order_statistics.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr std::size_t kGapsKept = 9;
constexpr std::size_t kOrderKept = 20;
constexpr double kPeriodsToLoss = 2.5;

}  // namespace

const char* sensor_name(Stream stream) {
  constexpr std::array<const char*, kStreams> kNames = {"left camera", "lidar", "attitude", "position",
                                                        "height"};
  return kNames[static_cast<std::size_t>(stream)];
}

void MessageClock::saw(Stream stream, std::int64_t t_ns) {
  latest_ns_[static_cast<std::size_t>(stream)] = t_ns;
}

std::optional<std::int64_t> MessageClock::now_ns() const {
  std::vector<std::int64_t> stamps_ns;
  for (const auto& latest_ns : latest_ns_) {
    if (latest_ns) stamps_ns.push_back(*latest_ns);
  }
  if (stamps_ns.empty()) return std::nullopt;
  std::sort(stamps_ns.rbegin(), stamps_ns.rend());
  return stamps_ns[std::min<std::size_t>(1, stamps_ns.size() - 1)];
}

StreamWatch::StreamWatch(const HealthConfig& config, Stream stream, bool needed)
    : config_(config),
      needed_(needed),
      lost_(sensor_name(stream), "lost"),
      clock_(sensor_name(stream), "clock jump"),
      order_(sensor_name(stream), "out of order") {}

bool StreamWatch::add(std::int64_t t_ns, std::int64_t now_ns, double slack_s) {
  const double ahead_s = to_seconds(t_ns - now_ns);
  const bool wrong = ahead_s > config_.max_ahead_s + slack_s || ahead_s < -config_.max_behind_s;
  clock_.look(config_, now_ns, wrong, fmt::format("stamps are {:+.3f} s off the other sensors'", ahead_s));
  if (wrong) return false;
  note_order(t_ns, now_ns);
  if (last_ns_ && t_ns > *last_ns_) {
    gaps_ns_.push_back(t_ns - *last_ns_);
    if (gaps_ns_.size() > kGapsKept) gaps_ns_.pop_front();
  }
  last_ns_ = std::max(last_ns_.value_or(t_ns), t_ns);
  return true;
}

void StreamWatch::note_order(std::int64_t t_ns, std::int64_t now_ns) {
  late_.push_back(previous_ns_ && t_ns < *previous_ns_);
  previous_ns_ = t_ns;
  if (late_.size() > kOrderKept) late_.pop_front();
  const auto late = static_cast<double>(std::count(late_.begin(), late_.end(), true));
  // Two of a handful are no habit yet: a sensor of 10 Hz has to be judged by few messages.
  const bool disorder = late >= 2 && late > config_.max_disorder_share * static_cast<double>(late_.size());
  order_.look(config_, now_ns, disorder,
              fmt::format("{:.0f} % of its last messages are older than the one before",
                          100 * late / static_cast<double>(late_.size())));
}

void StreamWatch::pass(std::int64_t now_ns, std::int64_t begin_ns) {
  if (clock_.present()) return lost_.clear();
  if (!last_ns_) {
    if (needed_ && to_seconds(now_ns - begin_ns) > config_.start_s) lost_.raise(now_ns, "no message so far");
    return;
  }
  const double silent_s = to_seconds(now_ns - *last_ns_);
  if (silent_s > std::max(config_.lost_after_s, kPeriodsToLoss * period_s())) {
    lost_.raise(lost_.present() ? lost_.finding().since_ns : now_ns,
                fmt::format("no message for {:.2f} s", silent_s));
  } else {
    lost_.clear();
  }
}

double StreamWatch::period_s() const {
  if (gaps_ns_.empty()) return 0;
  return to_seconds(median(std::vector<std::int64_t>(gaps_ns_.begin(), gaps_ns_.end())));
}

void StreamWatch::report(std::vector<HealthFinding>& findings) const {
  lost_.report(findings);
  clock_.report(findings);
  order_.report(findings);
}

}  // namespace alight
