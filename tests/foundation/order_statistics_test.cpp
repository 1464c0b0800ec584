#include "foundation/order_statistics.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(OrderStatistics, TheMedianIsTheMiddleValueOrTheUpperOfTwo) {
  EXPECT_EQ(median(std::vector<double>{7}), 7);
  EXPECT_EQ(median(std::vector<double>{3, 9, 1}), 3);
  EXPECT_EQ(median(std::vector<float>{4, 1, 10, 2}), 4);
  EXPECT_EQ(median(std::vector<std::int64_t>{5, 2}), 5);
}

TEST(OrderStatistics, PlacesOfShuffledNumbersAreTheNumbers) {
  std::vector<int> values(101);
  std::iota(values.begin(), values.end(), 0);
  std::mt19937 random(1);
  for (int place = 0; place <= 100; ++place) {
    std::shuffle(values.begin(), values.end(), random);
    EXPECT_EQ(value_at_place(values, static_cast<std::size_t>(place)), place);
    EXPECT_EQ(std::accumulate(values.begin(), values.end(), 0), 5050) << "a value is lost";
  }
}

TEST(OrderStatistics, AQuantileRoundsItsPlaceDown) {
  std::vector<int> values = {40, 10, 30, 20};
  EXPECT_EQ(quantile(values, 0), 10);
  EXPECT_EQ(quantile(values, 0.5), 20);
  EXPECT_EQ(quantile(values, 0.99), 30);
  EXPECT_EQ(quantile(values, 1), 40);
}

}  // namespace
}  // namespace alight
