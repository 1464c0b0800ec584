#include "train/schedule.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(Schedule, StepFallsAfterTheEpoch) {
  ScheduleConfig c;
  EXPECT_EQ(learning_rate_factor(c, 20, 1000, 2000), 1);
  EXPECT_EQ(learning_rate_factor(c, 21, 1000, 2000), 0.1);
  c.drop_after_epoch = 0;
  EXPECT_EQ(learning_rate_factor(c, 99, 1000, 2000), 1);
}

TEST(Schedule, WarmUpRisesLinearly) {
  ScheduleConfig c;
  c.warmup_steps = 10;
  EXPECT_EQ(learning_rate_factor(c, 1, 0, 100), 0.1);
  EXPECT_EQ(learning_rate_factor(c, 1, 9, 100), 1);
}

TEST(Schedule, ConstantStays) {
  ScheduleConfig c;
  c.kind = ScheduleKind::kConstant;
  EXPECT_EQ(learning_rate_factor(c, 1, 0, 100), 1);
  EXPECT_EQ(learning_rate_factor(c, 99, 99, 100), 1);
}

TEST(Schedule, CosineFallsFromOneToTheFinalFactor) {
  ScheduleConfig c;
  c.kind = ScheduleKind::kCosine;
  c.warmup_steps = 100;
  c.final_factor = 0.2;
  EXPECT_NEAR(learning_rate_factor(c, 1, 100, 1100), 1, 1e-12);
  EXPECT_NEAR(learning_rate_factor(c, 1, 600, 1100), 0.6, 1e-12);
  EXPECT_NEAR(learning_rate_factor(c, 1, 1100, 1100), 0.2, 1e-12);
  EXPECT_NEAR(learning_rate_factor(c, 1, 5000, 1100), 0.2, 1e-12);
}

}  // namespace
}  // namespace alight
