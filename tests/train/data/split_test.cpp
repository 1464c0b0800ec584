#include "train/data/split.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"

namespace alight {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// One sample a second, from 0 s to `last_s`.
std::vector<SampleTime> flight(const std::string& name, int last_s) {
  std::vector<SampleTime> samples;
  for (int t_s = 0; t_s <= last_s; ++t_s) samples.push_back({name, 5'000'000'000 + t_s * 1'000'000'000LL});
  return samples;
}

std::vector<SampleTime> joined(std::vector<SampleTime> a, const std::vector<SampleTime>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(Split, BlocksAreHeldOutAndTheirSurroundingsLeftOut) {
  const SampleSplit split = choose(flight("a", 10), {{}, {{0.4, 0.6}}, 2.0});
  EXPECT_THAT(split.held_out, ElementsAre(4, 5));  // 6 s is the block's open end
  EXPECT_THAT(split.training, ElementsAre(0, 1, 2, 8, 9, 10));
  EXPECT_THAT(split.unknown, IsEmpty());
}

TEST(Split, WithoutAGapEverySampleIsInOnePart) {
  const SampleSplit split = choose(flight("a", 10), {{}, {{0.4, 0.6}}, 0.0});
  EXPECT_THAT(split.held_out, ElementsAre(4, 5));
  EXPECT_THAT(split.training, ElementsAre(0, 1, 2, 3, 6, 7, 8, 9, 10));
}

TEST(Split, ABlockToTheEndHoldsTheLastSample) {
  EXPECT_THAT(choose(flight("a", 10), {{}, {{0.8, 1.0}}, 1.5}).held_out, ElementsAre(8, 9, 10));
}

TEST(Split, SharesAreOfEachFlightsOwnDuration) {
  const auto samples = joined(flight("short", 2), flight("long", 8));
  EXPECT_THAT(choose(samples, {{}, {{0.5, 0.75}}, 0.0}).held_out, ElementsAre(1, 3 + 4, 3 + 5));
}

TEST(Split, AnUnknownFlightIsInNoOtherPart) {
  const auto samples = joined(flight("a", 3), flight("b", 3));
  const SampleSplit split = choose(samples, {{"b"}, {{0.0, 0.5}}, 0.0});
  EXPECT_THAT(split.unknown, ElementsAre(4, 5, 6, 7));
  EXPECT_THAT(split.held_out, ElementsAre(0, 1));
  EXPECT_THAT(split.training, ElementsAre(2, 3));
}

TEST(Split, AMisspeltFlightIsAnErrorThatNamesTheFlights) {
  try {
    choose(joined(flight("meadow", 1), flight("roofs", 1)), {{"medow"}, {}, 0});
    FAIL() << "accepted";
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), HasSubstr("medow"));
    EXPECT_THAT(error.what(), HasSubstr("meadow, roofs"));
  }
}

TEST(Split, BlocksOutsideTheFlightAreRefused) {
  for (const char* blocks : {"[[0.6, 0.4]]", "[[0.5, 1.5]]", "[[0.5]]", "[[-0.1, 0.2]]"}) {
    EXPECT_THROW(parse_config<SplitConfig>(std::string("held_out_blocks: ") + blocks, "split.yaml"),
                 ConfigError)
        << blocks;
  }
  EXPECT_EQ(parse_config<SplitConfig>("held_out_blocks: [[0.4, 0.6]]", "split.yaml").held_out_blocks[0][1],
            0.6);
}

TEST(Split, AGapShorterThanTheWindowOfADepthMapLeaks) {
  SplitConfig config;
  config.gap_s = 1;
  EXPECT_EQ(leak_through_gap(config, 2), "") << "nothing is held out";
  config.held_out_blocks = {{0.4, 0.6}};
  EXPECT_THAT(leak_through_gap(config, 2),
              AllOf(HasSubstr("split.gap_s: 1 s"), HasSubstr("set it to 2 or more")));
  config.gap_s = 2;
  EXPECT_EQ(leak_through_gap(config, 2), "");
}

}  // namespace
}  // namespace alight
