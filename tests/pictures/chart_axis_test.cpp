#include "pictures/chart_axis.hpp"

#include <stdexcept>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace alight {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

std::vector<std::string> labels(const ChartAxis& axis) {
  std::vector<std::string> out;
  for (const AxisTick& tick : axis.ticks) out.push_back(tick.label);
  return out;
}

TEST(ChartAxis, LinearTicksAreRound) {
  EXPECT_THAT(labels(linear_axis(0, 1)), ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1"));
  EXPECT_THAT(labels(linear_axis(-7, 23)), ElementsAre("-5", "0", "5", "10", "15", "20"));
  EXPECT_THAT(labels(linear_axis(0, 1e-4)), ElementsAre("0", "2e-5", "4e-5", "6e-5", "8e-5", "0.0001"));
}

TEST(ChartAxis, WholeTicksOfFewEpochs) {
  EXPECT_THAT(labels(linear_axis(1, 3, /*whole=*/true)), ElementsAre("1", "2", "3"));
  EXPECT_THAT(labels(linear_axis(1, 3)), SizeIs(5));
}

TEST(ChartAxis, RangeOfNoLengthIsWidened) {
  const ChartAxis epoch = linear_axis(1, 1, /*whole=*/true);
  EXPECT_THAT(labels(epoch), ElementsAre("0", "1", "2"));
  EXPECT_DOUBLE_EQ(epoch.share(1), 0.5);
  EXPECT_DOUBLE_EQ(linear_axis(0, 0).share(0), 0.5);
  EXPECT_DOUBLE_EQ(linear_axis(-300, -300).share(-300), 0.5);
  EXPECT_NEAR(logarithmic_axis(7, 7).share(7), 0.5, 1e-9);
}

TEST(ChartAxis, LogarithmicTicks) {
  EXPECT_THAT(labels(logarithmic_axis(0.06, 1.5)), ElementsAre("0.1", "0.2", "0.5", "1"));
  EXPECT_THAT(labels(logarithmic_axis(1e-3, 1e3)),
              ElementsAre("0.001", "0.01", "0.1", "1", "10", "100", "1000"));
  EXPECT_THAT(labels(logarithmic_axis(300, 400)), ElementsAre("300", "320", "340", "360", "380", "400"));
  EXPECT_LE(logarithmic_axis(1e-30, 1e30).ticks.size(), 8U);
}

TEST(ChartAxis, SharesOfALogarithmicAxisAreFactors) {
  const ChartAxis axis = logarithmic_axis(1, 100);
  EXPECT_NEAR(axis.share(10), 0.5, 1e-12);
  EXPECT_NEAR(axis.share(10) - axis.share(1), axis.share(100) - axis.share(10), 1e-12);
  EXPECT_GT(axis.share(1), 0);
  EXPECT_LT(axis.share(100), 1);
}

TEST(ChartAxis, LogarithmOfNothingIsRefused) {
  EXPECT_THROW(logarithmic_axis(0, 1), std::invalid_argument);
  EXPECT_THROW(logarithmic_axis(2, 1), std::invalid_argument);
}

TEST(TickLabel, IsShort) {
  EXPECT_EQ(tick_label(1500), "1500");
  EXPECT_EQ(tick_label(2e-5), "2e-5");
  EXPECT_EQ(tick_label(3e7), "3e7");
  EXPECT_EQ(tick_label(1e-10), "1e-10");
  EXPECT_EQ(tick_label(-0.25), "-0.25");
}

}  // namespace
}  // namespace alight
