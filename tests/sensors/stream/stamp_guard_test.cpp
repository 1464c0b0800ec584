#include "sensors/stream/stamp_guard.hpp"

#include <gtest/gtest.h>

#include "tests/sensors/test_flight.hpp"

namespace alight::testing {
namespace {

constexpr std::int64_t kGuardMillisecond = 1'000'000;

/// Feeds a topic of 20 Hz; stamps lag behind the receipt by 30 ms.
class StampGuardTest : public ::testing::Test {
 protected:
  /// The next message, its stamp and receipt late by so much. @returns whether it is usable
  bool next(std::int64_t stamp_late_ms = 0, std::int64_t receipt_late_ms = 0) {
    now_ns_ += 50 * kGuardMillisecond;
    return guard_.usable(now_ns_ - 30 * kGuardMillisecond + stamp_late_ms * kGuardMillisecond,
                         now_ns_ + receipt_late_ms * kGuardMillisecond);
  }
  StampGuard guard_;
  std::int64_t now_ns_ = kStart_ns;
};

TEST_F(StampGuardTest, RegularStampsAreUsable) {
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(next());
}

TEST_F(StampGuardTest, OneThatJumpsIsNotAndTheNextIs) {
  for (const std::int64_t jump_ms : {600, 3'000, 1'000'000'000, -600, -3'000, -1'000'000'000}) {
    EXPECT_TRUE(next());
    EXPECT_FALSE(next(jump_ms)) << jump_ms;
    EXPECT_TRUE(next()) << jump_ms;
  }
}

TEST_F(StampGuardTest, ARecorderThatStallsChangesNothing) {
  EXPECT_TRUE(next());
  for (std::int64_t late_ms = 3000; late_ms >= 0; late_ms -= 50) EXPECT_TRUE(next(0, late_ms));
  EXPECT_TRUE(next());
}

TEST_F(StampGuardTest, ASensorThatPausesChangesNothing) {
  EXPECT_TRUE(next());
  now_ns_ += 10'000 * kGuardMillisecond;
  EXPECT_TRUE(next());
}

TEST_F(StampGuardTest, AClockThatWasSetIsFollowedAfterFiveMessages) {
  EXPECT_TRUE(next());
  for (int i = 1; i < StampGuard::kAgreeing; ++i) EXPECT_FALSE(next(3'600'000)) << i;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(next(3'600'000)) << i;
}

TEST_F(StampGuardTest, JumpsThatDoNotAgreeAreNoClockThatWasSet) {
  EXPECT_TRUE(next());
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(next(2000 + i * 7000 * (i % 2 == 0 ? 1 : -1)));
  EXPECT_TRUE(next());
}

TEST_F(StampGuardTest, AWrongFirstStampCostsFourMessagesNotTheLog) {
  EXPECT_TRUE(next(100'000'000));  // nothing to hold it against
  int lost = 0;
  while (!next()) ++lost;
  EXPECT_EQ(lost, StampGuard::kAgreeing - 1);
}

}  // namespace
}  // namespace alight::testing
