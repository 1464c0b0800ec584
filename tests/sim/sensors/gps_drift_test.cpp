#include "sim/sensors/gps_drift.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace alight::sim {
namespace {

GpsConfig drifting(DriftKind kind, double rate_hz = 50) {
  GpsConfig config;
  config.drift_kind = kind;
  config.rate_hz = rate_hz;
  return config;
}

/// Mean over seeds and axes of the product of two fixes.
double covariance_m2(const GpsConfig& config, std::size_t a, std::size_t b, int seeds) {
  double sum = 0;
  const double duration_s = static_cast<double>(std::max(a, b)) / config.rate_hz;
  for (int seed = 0; seed < seeds; ++seed) {
    const auto values = gps_drift(config, duration_s, static_cast<std::uint64_t>(seed));
    sum += values.at(a).dot(values.at(b)) / 3;
  }
  return sum / seeds;
}

TEST(GpsDrift, TheRoughKindIsTheOneOfTheFlightsSoFar) {
  // Figures of the first version of the simulator: recorded flights are made from them.
  const auto values = gps_drift(drifting(DriftKind::kRough), 10, 42);
  EXPECT_EQ(values.front(), Eigen::Vector3d::Zero());
  EXPECT_NEAR(values.at(50).x(), 0.025377816632142, 1e-12);
  EXPECT_NEAR(values.at(500).y(), 0.012656254224086, 1e-12);
  EXPECT_NEAR(values.at(500).z(), -0.052727231837025, 1e-12);
}

TEST(GpsDrift, TheSmoothKindHasTheVarianceOfItsClosedForm) {
  const GpsConfig config = drifting(DriftKind::kSmooth, 2);
  const double b = smooth_drift_rate_per_s(config);
  for (const double t_s : {1.0, 10.0, 60.0, 400.0}) {
    // The stationary process, whose position is known to be 0 at first: what is left of its variance.
    const double expected =
        std::pow(config.drift_m, 2) * (1 - std::pow((1 + b * t_s) * std::exp(-b * t_s), 2));
    const auto k = static_cast<std::size_t>(t_s * config.rate_hz);
    EXPECT_NEAR(covariance_m2(config, k, k, 4000) / expected, 1, 0.05) << t_s;
  }
}

TEST(GpsDrift, ItsCorrelationHasFallenToOneEthAfterItsTime) {
  const GpsConfig config = drifting(DriftKind::kSmooth, 0.1);
  const double b = smooth_drift_rate_per_s(config);
  EXPECT_NEAR((1 + b * config.drift_time_s) * std::exp(-b * config.drift_time_s), std::exp(-1), 1e-12);
  // Settled after 600 s; 60 s apart.
  EXPECT_NEAR(covariance_m2(config, 60, 66, 4000) / std::pow(config.drift_m, 2), std::exp(-1), 0.03);
}

TEST(GpsDrift, SmoothIsTheSameProcessAtEveryRate) {
  for (const double rate_hz : {0.5, 5.0, 50.0}) {
    const GpsConfig config = drifting(DriftKind::kSmooth, rate_hz);
    const double b = smooth_drift_rate_per_s(config);
    const auto k = static_cast<std::size_t>(30 * rate_hz);
    const double expected = std::pow(config.drift_m, 2) * (1 - std::pow((1 + b * 30) * std::exp(-b * 30), 2));
    EXPECT_NEAR(covariance_m2(config, k, k, 1500) / expected, 1, 0.08) << rate_hz;
  }
}

/// 1 sigma of what a settled drift changes by in a second.
double second_m(DriftKind kind) {
  const auto values = gps_drift(drifting(kind), 3000, 5);
  double squares_m2 = 0;
  int count = 0;
  for (std::size_t k = 10'000; k + 50 < values.size(); k += 7, ++count)
    squares_m2 += (values[k + 50] - values[k]).squaredNorm() / 3;
  return std::sqrt(squares_m2 / count);
}

TEST(GpsDrift, ASecondOfTheRoughKindHasStepsThatTheSmoothOneHasNot) {
  const GpsConfig config;
  EXPECT_NEAR(second_m(DriftKind::kRough), config.drift_m * std::sqrt(2 * (1 - std::exp(-1 / 60.0))), 0.005);
  EXPECT_NEAR(second_m(DriftKind::kSmooth), config.drift_m * smooth_drift_rate_per_s(config), 0.002);
}

}  // namespace
}  // namespace alight::sim
