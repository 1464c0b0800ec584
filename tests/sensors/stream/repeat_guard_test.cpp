#include "sensors/stream/repeat_guard.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(RepeatGuard, TheSameBytesShortlyAfterAreARepetition) {
  RepeatGuard guard;
  std::vector<std::uint8_t> first = {1, 2, 3};
  std::vector<std::uint8_t> second = {1, 2, 4};
  EXPECT_FALSE(guard.repeated({first.data(), first.size(), 0}));
  EXPECT_FALSE(guard.repeated({second.data(), second.size(), 1}));
  EXPECT_TRUE(guard.repeated({first.data(), first.size(), 2})) << "received later";
  EXPECT_TRUE(guard.repeated({second.data(), second.size(), 3}));
  for (std::uint8_t i = 10; i < 20; ++i) EXPECT_FALSE(guard.repeated({&i, 1, 0}));
  EXPECT_FALSE(guard.repeated({first.data(), first.size(), 4})) << "long ago";
}

}  // namespace
}  // namespace alight
