#include "infer/autopilot/rate_limit.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

using Milliseconds = std::chrono::milliseconds;

const SteadyTime kStart{std::chrono::hours(1)};

int allowed(RateLimit& limit, int count, Milliseconds apart, Milliseconds from = Milliseconds(0)) {
  int passed = 0;
  for (int i = 0; i < count; ++i) passed += limit.allow(kStart + from + i * apart) ? 1 : 0;
  return passed;
}

TEST(RateLimit, HalvesTwiceTheRate) {
  RateLimit limit(10);
  EXPECT_EQ(allowed(limit, 200, Milliseconds(50)), 100);
}

TEST(RateLimit, LetsASlowerStreamThrough) {
  RateLimit limit(10);
  EXPECT_EQ(allowed(limit, 50, Milliseconds(130)), 50);
}

TEST(RateLimit, JitterAtTheVeryRateLosesNothingInTheLongRun) {
  RateLimit limit(10);
  int passed = 0;
  for (int i = 0; i < 100; ++i)
    passed += limit.allow(kStart + Milliseconds(100 * i + (i % 2 == 1 ? 8 : 0))) ? 1 : 0;
  EXPECT_EQ(passed, 100);
}

TEST(RateLimit, APauseIsNoCreditForABurst) {
  RateLimit limit(10);
  EXPECT_EQ(allowed(limit, 1, Milliseconds(0)), 1);
  EXPECT_EQ(allowed(limit, 100, Milliseconds(1), std::chrono::seconds(60)), 1);
}

}  // namespace
}  // namespace alight
