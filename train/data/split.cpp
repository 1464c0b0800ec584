#include "train/data/split.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "foundation/config_reader.hpp"

namespace alight {
namespace {

struct Span {
  std::int64_t begin_ns;
  std::int64_t end_ns;
};

std::map<std::string, Span> flight_spans(const std::vector<SampleTime>& samples) {
  std::map<std::string, Span> spans;
  for (const SampleTime& sample : samples) {
    Span& span = spans.try_emplace(sample.flight, Span{sample.t_ns, sample.t_ns}).first->second;
    span.begin_ns = std::min(span.begin_ns, sample.t_ns);
    span.end_ns = std::max(span.end_ns, sample.t_ns);
  }
  return spans;
}

void check_names(const std::vector<std::string>& unknown_flights, const std::map<std::string, Span>& spans) {
  for (const std::string& name : unknown_flights) {
    if (spans.count(name) > 0) continue;
    std::string known;
    for (const auto& [flight, span] : spans) known += (known.empty() ? "" : ", ") + flight;
    throw ConfigError("unknown_flights: there is no flight \"" + name + "\"; the data set has " + known);
  }
}

enum class Part { kTraining, kHeldOut, kGap };

Part part_of(std::int64_t t_ns, const Span& flight, const SplitConfig& config) {
  const double duration_s = static_cast<double>(flight.end_ns - flight.begin_ns) * 1e-9;
  const double t_s = static_cast<double>(t_ns - flight.begin_ns) * 1e-9;
  Part part = Part::kTraining;
  for (const std::vector<double>& block : config.held_out_blocks) {
    const double begin_s = block[0] * duration_s;
    const double end_s = block[1] * duration_s;
    if (t_s >= begin_s && (t_s < end_s || block[1] >= 1)) return Part::kHeldOut;
    if (std::max(begin_s - t_s, t_s - end_s) < config.gap_s) part = Part::kGap;
  }
  return part;
}

bool is_block(const std::vector<double>& block) {
  return block.size() == 2 && block[0] >= 0 && block[0] < block[1] && block[1] <= 1;
}

}  // namespace

void bind(Binder& b, SplitConfig& c) {
  b.field("unknown_flights", c.unknown_flights, "flights that are never trained on: unknown places");
  b.field("held_out_blocks", c.held_out_blocks,
          "[begin, end] as shares of a flight's duration, held out of every other flight");
  b.field("gap_s", c.gap_s, "samples nearer to a held-out block are not trained on either", at_least(0));
  b.check("held_out_blocks", std::all_of(c.held_out_blocks.begin(), c.held_out_blocks.end(), is_block),
          "expected blocks like [0.4, 0.6], within 0..1 and begin before end");
}

SampleSplit choose(const std::vector<SampleTime>& samples, const SplitConfig& config) {
  const std::map<std::string, Span> spans = flight_spans(samples);
  check_names(config.unknown_flights, spans);
  SampleSplit split;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& names = config.unknown_flights;
    if (std::find(names.begin(), names.end(), samples[i].flight) != names.end()) {
      split.unknown.push_back(i);
      continue;
    }
    const Part part = part_of(samples[i].t_ns, spans.at(samples[i].flight), config);
    if (part == Part::kTraining) split.training.push_back(i);
    if (part == Part::kHeldOut) split.held_out.push_back(i);
  }
  return split;
}

std::string leak_through_gap(const SplitConfig& config, double window_s) {
  if (config.held_out_blocks.empty() || config.gap_s >= window_s) return {};
  return fmt::format(
      "split.gap_s: {:g} s is less than the {:g} s over which a depth map of this data set collects LiDAR "
      "points: held-out maps share points with those learned from; set it to {:g} or more",
      config.gap_s, window_s, window_s);
}

}  // namespace alight
