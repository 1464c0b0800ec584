#include "train/evaluation/self/roc.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace alight {
namespace {

using ::testing::DoubleEq;
using ::testing::DoubleNear;
using ::testing::Optional;

constexpr double kNoEvidence = -std::numeric_limits<double>::infinity();

TEST(Roc, PerfectAndReversedSeparation) {
  EXPECT_THAT(area_under_roc({{3, true}, {2, true}, {1, false}}), Optional(DoubleEq(1)));
  EXPECT_THAT(area_under_roc({{3, false}, {2, true}, {1, true}}), Optional(DoubleEq(0)));
  EXPECT_THAT(false_accept_rate_at({{3, true}, {2, true}, {1, false}}, 1), Optional(DoubleEq(0)));
  EXPECT_THAT(false_accept_rate_at({{3, false}, {2, true}, {1, true}}, 0.5), Optional(DoubleEq(1)));
}

TEST(Roc, TheAreaIsTheShareOfPairsInTheRightOrder) {
  // Good 4 and 2, bad 3 and 1: of the four pairs only (2, 3) is in the wrong order.
  EXPECT_THAT(area_under_roc({{1, false}, {4, true}, {3, false}, {2, true}}), Optional(DoubleEq(0.75)));
}

TEST(Roc, EqualScoresCountHalfInWhateverOrderTheyCome) {
  EXPECT_THAT(area_under_roc({{1, true}, {1, false}}), Optional(DoubleEq(0.5)));
  EXPECT_THAT(area_under_roc({{1, false}, {1, true}}), Optional(DoubleEq(0.5)));
  // Pairs: (2, 1) right, (2, 2) a half, (1, 1) a half, (1, 2) wrong.
  EXPECT_THAT(area_under_roc({{2, true}, {1, true}, {2, false}, {1, false}}), Optional(DoubleEq(0.5)));
  EXPECT_EQ(roc_curve({{1, true}, {1, false}, {1, true}}).size(), 2U);
  EXPECT_THAT(false_accept_rate_at({{1, true}, {1, false}}, 0.1), Optional(DoubleEq(1)));
}

TEST(Roc, OneKindAloneHasNoCurve) {
  for (const bool good : {true, false}) {
    const std::vector<ScoredCase> cases{{1, good}, {2, good}};
    EXPECT_TRUE(roc_curve(cases).empty());
    EXPECT_EQ(area_under_roc(cases), std::nullopt);
    EXPECT_EQ(false_accept_rate_at(cases, 0.95), std::nullopt);
  }
  EXPECT_TRUE(roc_curve({}).empty());
}

TEST(Roc, TheCurveRunsFromCornerToCorner) {
  const std::vector<RocPoint> curve = roc_curve({{2, true}, {1, false}, {0, true}, {-1, false}});
  ASSERT_EQ(curve.size(), 5U);
  const double expected[][2] = {{0, 0}, {0, 0.5}, {0.5, 0.5}, {0.5, 1}, {1, 1}};
  for (std::size_t i = 0; i < curve.size(); ++i) {
    EXPECT_EQ(curve[i].false_accept_rate, expected[i][0]) << i;
    EXPECT_EQ(curve[i].recall, expected[i][1]) << i;
  }
  EXPECT_EQ(curve[3].threshold, 0);
}

TEST(Roc, NoThresholdAcceptsWithoutEvidence) {
  const std::vector<ScoredCase> cases{{1, true}, {0, false}, {kNoEvidence, true}, {kNoEvidence, false}};
  EXPECT_THAT(false_accept_rate_at(cases, 0.5), Optional(DoubleEq(0)));
  EXPECT_EQ(false_accept_rate_at(cases, 0.95), std::nullopt);
  // Pairs: (1, 0) and (1, none) right, (none, 0) wrong, (none, none) a half.
  EXPECT_THAT(area_under_roc(cases), Optional(DoubleEq(0.625)));
}

TEST(Roc, TheStandardErrorIsThatOfDrawingFlights) {
  const std::vector<ScoredCase> right{{1, true}, {0, false}};
  const std::vector<ScoredCase> wrong{{0, true}, {1, false}};
  EXPECT_EQ(area_standard_error({{"a", right}}), std::nullopt);
  EXPECT_THAT(area_standard_error({{"a", right}, {"b", right}}), Optional(DoubleNear(0, 1e-12)));
  // Areas 1, 0.5, 0 with chances 1/4, 1/2, 1/4 (ties count half): standard deviation sqrt(1/8).
  const auto error = area_standard_error({{"a", right}, {"b", wrong}}, 4000);
  ASSERT_TRUE(error);
  EXPECT_NEAR(*error, 0.3536, 0.02);
  EXPECT_EQ(area_standard_error({{"a", right}, {"b", wrong}}, 50, 7),
            area_standard_error({{"a", right}, {"b", wrong}}, 50, 7));
}

TEST(Roc, AFlightWithoutOneKindDoesNotSpoilTheOthers) {
  const FlightCases flights{{"a", {{1, true}, {0, false}}}, {"b", {{2, true}}}, {"c", {{0.5, false}}}};
  EXPECT_EQ(pooled(flights).size(), 4U);
  EXPECT_TRUE(area_standard_error(flights));
  EXPECT_EQ(area_standard_error({{"a", {{1, true}}}, {"b", {{2, true}}}}), std::nullopt);
}

}  // namespace
}  // namespace alight
