#include "train/evaluation/scores/evaluation_config.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>

#include "foundation/config_reader.hpp"

namespace alight {
namespace {

std::vector<std::size_t> part_of(const std::vector<SampleTime>& samples, const EvaluationConfig& config) {
  if (config.part == EvaluatedPart::kAll) {
    std::vector<std::size_t> all(samples.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  }
  const SampleSplit split = choose(samples, config.split);
  if (config.part == EvaluatedPart::kTraining) return split.training;
  if (config.part == EvaluatedPart::kHeldOut) return split.held_out;
  if (config.part == EvaluatedPart::kUnknown) return split.unknown;
  std::vector<std::size_t> both;
  std::merge(split.held_out.begin(), split.held_out.end(), split.unknown.begin(), split.unknown.end(),
             std::back_inserter(both));
  return both;
}

void check_flights(const std::vector<std::string>& names, const std::vector<SampleTime>& samples) {
  for (const std::string& name : names) {
    const auto is_it = [&](const SampleTime& sample) { return sample.flight == name; };
    if (std::any_of(samples.begin(), samples.end(), is_it)) continue;
    std::string known;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (i > 0 && samples[i].flight == samples[i - 1].flight) continue;
      known += (known.empty() ? "" : ", ") + samples[i].flight;
    }
    throw ConfigError("flights: there is no flight \"" + name + "\"; the data set has " + known);
  }
}

}  // namespace

const char* name(EvaluatedPart part) {
  switch (part) {
    case EvaluatedPart::kAll:
      break;
    case EvaluatedPart::kTraining:
      return "training";
    case EvaluatedPart::kHeldOut:
      return "held_out";
    case EvaluatedPart::kUnknown:
      return "unknown";
    case EvaluatedPart::kAllButTraining:
      return "all_but_training";
  }
  return "all";
}

void bind(Binder& b, EvaluationConfig& c) {
  b.field("flights", c.flights, "flights to judge; none: all");
  b.section("split", c.split, "parts of a data set, as in training");
  b.choice("part", c.part,
           {{"all", EvaluatedPart::kAll},
            {"training", EvaluatedPart::kTraining},
            {"held_out", EvaluatedPart::kHeldOut},
            {"unknown", EvaluatedPart::kUnknown},
            {"all_but_training", EvaluatedPart::kAllButTraining}},
           "which part of the split is judged; all: the split does not matter");
  b.field("every", c.every, "every n-th sample of a flight", at_least(1));
  b.field("shares", c.shares, "shares of the points fed (P)", between(0, 1));
  b.field("windows_s", c.windows_s, "accumulation windows fed, from the image on", at_least(0));
  b.field("seed", c.seed, "of the random shares", at_least(0));
  b.field("threads", c.threads, "samples judged at once; 0: all cores", between(0, 1024));
  b.field("picture_feeding", c.picture_feeding,
          "what the worst samples are chosen by, such as P=0.3 or \"0.3 s\"");
  b.section("regions", c.regions, "pixels that are judged apart");
  b.section("baselines", c.baselines, "methods without training");
  const std::vector<Feeding> feedings = c.feedings();
  b.check("shares", !feedings.empty(), "expected a share here or a window in windows_s");
  b.check("picture_feeding",
          std::any_of(feedings.begin(), feedings.end(),
                      [&](const Feeding& feeding) { return feeding.name() == c.picture_feeding; }),
          "expected a share (such as P=0.3) or window (0.3 s) that is in shares or windows_s");
}

std::vector<EvaluationItem> choose_items(const std::vector<SampleTime>& samples,
                                         const EvaluationConfig& config) {
  check_flights(config.flights, samples);
  std::vector<EvaluationItem> items;
  std::map<std::string, int> seen;
  for (const std::size_t index : part_of(samples, config)) {
    const std::string& flight = samples[index].flight;
    const auto& names = config.flights;
    if (!names.empty() && std::find(names.begin(), names.end(), flight) == names.end()) continue;
    if (seen[flight]++ % config.every == 0) items.push_back({index, flight});
  }
  if (items.empty()) {
    throw ConfigError(
        "no sample is left to judge: `part` of the split has none in the chosen flights; name other "
        "flights, blocks or unknown_flights");
  }
  return items;
}

}  // namespace alight
