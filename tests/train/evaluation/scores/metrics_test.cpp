#include "train/evaluation/scores/metrics.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(PixelErrors, HandComputedValues) {
  PixelErrors errors;
  errors.add(13, 10);   // +3 m, 30 %: outside delta
  errors.add(16, 20);   // -4 m, 20 %; 20 / 16 = 1.25 is not below 1.25
  errors.add(10, 10);   // exact
  errors.add(8.1, 10);  // 10 / 8.1 < 1.25
  EXPECT_NEAR(errors.value(Metric::kRmse), 1000 * std::sqrt((9 + 16 + 0 + 3.61) / 4), 1e-9);
  EXPECT_NEAR(errors.value(Metric::kMae), 1000 * (3 + 4 + 0 + 1.9) / 4, 1e-9);
  EXPECT_NEAR(errors.value(Metric::kRel), 1000 * (0.3 + 0.2 + 0 + 0.19) / 4, 1e-9);
  EXPECT_NEAR(errors.value(Metric::kDelta), 50, 1e-9);
  EXPECT_EQ(errors.pixels(), 4);
}

TEST(PixelErrors, NothingAddedIsNotANumber) {
  for (const Metric metric : kMetrics) EXPECT_TRUE(std::isnan(PixelErrors().value(metric))) << name(metric);
}

TEST(PixelErrors, SumsOfPartsAreThoseOfTheWhole) {
  PixelErrors a, b, whole;
  a.add(11, 10);
  whole.add(11, 10);
  b.add_substituted(30, 20);
  whole.add_substituted(30, 20);
  b.add_unknown();
  a += b;
  for (const Metric metric : kMetrics) EXPECT_EQ(a.value(metric), whole.value(metric)) << name(metric);
  EXPECT_EQ(a.pixels(), 2);
  EXPECT_EQ(a.substituted(), 1);
  EXPECT_EQ(a.unknown(), 1);
}

TEST(Measure, CountsPixelsWithTruthInsideTheMask) {
  const cv::Mat truth_m = (cv::Mat_<float>(1, 4) << 10, 0, 10, 10);
  const cv::Mat predicted_m = (cv::Mat_<float>(1, 4) << 11, 50, 12, 99);
  const cv::Mat mask = (cv::Mat_<std::uint8_t>(1, 4) << 255, 255, 255, 0);
  const PixelErrors errors = measure(predicted_m, {}, truth_m, mask);
  EXPECT_EQ(errors.pixels(), 2);
  EXPECT_NEAR(errors.value(Metric::kMae), 1500, 1e-9);
  EXPECT_EQ(measure(predicted_m, {}, truth_m, {}).pixels(), 3);
}

TEST(Measure, UnknownPixelsAreSubstitutedOrCounted) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const cv::Mat truth_m = (cv::Mat_<float>(1, 3) << 10, 10, 10);
  const cv::Mat predicted_m = (cv::Mat_<float>(1, 3) << 10, 0, nan);
  const cv::Mat substitute_m = (cv::Mat_<float>(1, 3) << 50, 13, 0);
  const PixelErrors errors = measure(predicted_m, substitute_m, truth_m, {});
  EXPECT_EQ(errors.pixels(), 2);
  EXPECT_EQ(errors.substituted(), 1);
  EXPECT_EQ(errors.unknown(), 1);
  EXPECT_NEAR(errors.value(Metric::kMae), 1500, 1e-9);
  EXPECT_EQ(measure(predicted_m, {}, truth_m, {}).unknown(), 2);
}

TEST(Measure, DifferentSizesAreRefused) {
  EXPECT_THROW(measure(cv::Mat::ones(2, 3, CV_32FC1), {}, cv::Mat::ones(3, 2, CV_32FC1), {}),
               std::invalid_argument);
}

TEST(FlightMean, IsMeanAndErrorOfTheMean) {
  const FlightMean mean = mean_over_flights({1, 2, std::nan(""), 6});
  EXPECT_EQ(mean.flights, 3);
  EXPECT_NEAR(mean.mean, 3, 1e-12);
  EXPECT_NEAR(mean.standard_error, std::sqrt((4 + 1 + 9) / 2.0 / 3.0), 1e-12);
  EXPECT_TRUE(std::isnan(mean_over_flights({5}).standard_error));
  EXPECT_TRUE(std::isnan(mean_over_flights({}).mean));
}

TEST(FlightErrors, PooledCountsPixelsMeanCountsFlights) {
  PixelErrors one, three;
  one.add(14, 10);
  for (int i = 0; i < 3; ++i) three.add(10, 10);
  FlightErrors errors;
  errors.add("a", one);
  errors.add("b", three);
  EXPECT_NEAR(errors.pooled().value(Metric::kMae), 1000, 1e-9);
  EXPECT_NEAR(errors.mean(Metric::kMae).mean, 2000, 1e-9);
  EXPECT_NEAR(errors.mean(Metric::kMae).standard_error, 2000, 1e-9);
}

TEST(FlightScores, PooledCountsSamplesMeanCountsFlights) {
  FlightScores scores;
  EXPECT_TRUE(std::isnan(scores.pooled()));
  scores.add("a", 0.2);
  scores.add("b", 0.8);
  scores.add("b", 0.8);
  EXPECT_NEAR(scores.pooled(), 0.6, 1e-12);
  EXPECT_NEAR(scores.mean().mean, 0.5, 1e-12);
  EXPECT_EQ(scores.samples(), 3);
}

}  // namespace
}  // namespace alight
