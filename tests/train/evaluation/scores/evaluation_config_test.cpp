#include "train/evaluation/scores/evaluation_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"

namespace alight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Two flights of ten samples, a second apart.
std::vector<SampleTime> samples() {
  std::vector<SampleTime> all;
  for (const char* flight : {"a", "b"}) {
    for (int i = 0; i < 10; ++i) all.push_back({flight, i * 1'000'000'000LL});
  }
  return all;
}

std::vector<std::size_t> chosen(const std::string& yaml) {
  std::vector<std::size_t> indices;
  for (const EvaluationItem& item :
       choose_items(samples(), parse_config<EvaluationConfig>(yaml, "evaluate.yaml"))) {
    EXPECT_EQ(item.flight, item.index < 10 ? "a" : "b");
    indices.push_back(item.index);
  }
  return indices;
}

std::string mistake(const std::string& yaml) {
  try {
    chosen(yaml);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "none";
}

TEST(EvaluationConfig, EveryNthSampleOfEachFlight) {
  EXPECT_THAT(chosen("every: 4"), ElementsAre(0, 4, 8, 10, 14, 18));
  EXPECT_THAT(chosen("{every: 4, flights: [b]}"), ElementsAre(10, 14, 18));
}

TEST(EvaluationConfig, PartsAreThoseOfTheSplit) {
  const std::string split = "split: {unknown_flights: [b], held_out_blocks: [[0.4, 0.6]], gap_s: 2}\npart: ";
  EXPECT_THAT(chosen(split + "held_out"), ElementsAre(4, 5));
  EXPECT_THAT(chosen(split + "training"), ElementsAre(0, 1, 8, 9));
  EXPECT_THAT(chosen(split + "unknown\nevery: 5"), ElementsAre(10, 15));
  EXPECT_THAT(chosen(split + "all_but_training\nevery: 5"), ElementsAre(4, 10, 15));
}

TEST(EvaluationConfig, MistakesAreNamed) {
  EXPECT_THAT(mistake("flights: [c]"), HasSubstr("no flight \"c\"; the data set has a, b"));
  EXPECT_THAT(mistake("part: held_out"), HasSubstr("no sample is left"));
  EXPECT_THAT(mistake("picture_feeding: P=0.4"), HasSubstr("picture_feeding"));
  EXPECT_THAT(mistake("{shares: [], windows_s: []}"), HasSubstr("shares"));
  EXPECT_THAT(mistake("{shares: [0.3], windows_s: [0.3], picture_feeding: 0.3 s}"), "none");
}

}  // namespace
}  // namespace alight
