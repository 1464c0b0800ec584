#include "models/layers/box_mean.hpp"

#include <gtest/gtest.h>

namespace alight {
namespace {

TEST(BoxMean, AgreesWithAveragePooling) {
  torch::manual_seed(1);
  const torch::Tensor x = torch::rand({2, 3, 23, 17});
  for (const std::int64_t side : {1, 3, 5, 9, 15, 33}) {
    const torch::Tensor expected = torch::avg_pool2d(x.to(torch::kFloat64), side, 1, side / 2,
                                                     /*ceil_mode=*/false, /*count_include_pad=*/false);
    EXPECT_LT((box_mean(x, side) - expected).abs().max().item<double>(), 1e-6) << side;
  }
}

TEST(BoxMean, WindowsLargerThanTheMapTakeTheMeanOfAll) {
  const torch::Tensor x = torch::rand({1, 1, 4, 3});
  EXPECT_LT((box_mean(x, 9) - x.mean()).abs().max().item<double>(), 1e-6);
}

TEST(BoxMean, RefusesEvenSides) {
  EXPECT_THROW(box_mean(torch::zeros({1, 1, 8, 8}), 4), std::invalid_argument);
}

}  // namespace
}  // namespace alight
