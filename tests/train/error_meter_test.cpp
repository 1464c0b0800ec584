#include "train/error_meter.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(ErrorMeter, ByHandOverTwoImages) {
  ErrorMeter meter;
  EXPECT_TRUE(std::isnan(meter.rmse_mm()));
  const auto map = [](std::vector<float> v) { return torch::tensor(v).view({1, 1, 1, -1}); };
  meter.add(map({1, 2, 9}), map({1, 4, 0}), map({1, 1, 0}) > 0);
  EXPECT_NEAR(meter.rmse_mm(), 1000 * std::sqrt(2.0), 1e-6);
  meter.add(map({5, 5, 5}), map({5, 5, 6}), map({0, 1, 1}) > 0);
  EXPECT_NEAR(meter.rmse_mm(), 1000 * std::sqrt(5.0 / 4), 1e-6);
  EXPECT_EQ(meter.pixels(), 4);
}

}  // namespace
}  // namespace alight
