#include "foundation/split_mix.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

// The numbers that Vigna's splitmix64.c prints for the seed 1234567.
TEST(SplitMix, DrawsWhatTheReferenceDraws) {
  const std::uint64_t drawn[] = {6457827717110365317ULL, 3203168211198807973ULL, 9817491932198370423ULL,
                                 4593380528125082431ULL, 16408922859458223821ULL};
  for (std::uint64_t i = 0; i < 5; ++i) EXPECT_EQ(split_mix(1234567, i), drawn[i]) << i;
}

TEST(SplitMix, TheLastIndexIsTheOneBeforeTheFirst) {
  // The state steps by an odd constant, so that the sequence is a ring: a seed one step on draws the same, one later.
  constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15ULL;
  EXPECT_EQ(split_mix(5 + kStep, ~std::uint64_t{0}), split_mix(5, 0));
}

}  // namespace
}  // namespace alight
