#include "sim/random.hpp"

#include <gmock/gmock.h>

namespace alight::sim {
namespace {

// The first numbers of pcg32-demo.c (O'Neill), which seeds with 42 and stream 54.
TEST(Random, DrawsWhatTheReferenceDraws) {
  Random random(42, 54);
  for (const std::uint32_t drawn :
       {0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU, 0xcbed606eU}) {
    EXPECT_EQ(random.next(), drawn);
  }
}

TEST(Random, PicksEveryOneAboutAsOften) {
  const std::vector<int> from = {0, 1, 2, 3};
  std::vector<int> counts(4, 0);
  Random random(1, 1);
  for (int i = 0; i < 4000; ++i) ++counts[static_cast<std::size_t>(random.pick(from))];
  EXPECT_THAT(counts, ::testing::Each(::testing::AllOf(::testing::Gt(880), ::testing::Lt(1120))));
}

}  // namespace
}  // namespace alight::sim
