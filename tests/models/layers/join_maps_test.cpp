#include "models/layers/join_maps.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "models/layers/convolution.hpp"

namespace alight {
namespace {

torch::Tensor random_map(std::int64_t channels, std::int64_t height, std::int64_t width, torch::Dtype type) {
  return torch::randn({2, channels, height, width}).to(type).contiguous(torch::MemoryFormat::ChannelsLast);
}

/// Pixel by pixel as the header says.
torch::Tensor joined_by_hand(const torch::Tensor& y, bool blocks, const std::vector<torch::Tensor>& addends,
                             bool rectify, std::int64_t height, std::int64_t width) {
  const std::int64_t channels = blocks ? y.size(1) / 4 : y.size(1);
  torch::Tensor out = torch::zeros({y.size(0), channels, height, width});
  for (std::int64_t v = 0; v < height; ++v) {
    for (std::int64_t u = 0; u < width; ++u) {
      const std::int64_t row = v % 2, column = u % 2;
      torch::Tensor value = blocks ? y.select(3, u / 2 + column)
                                         .select(2, v / 2 + row)
                                         .narrow(1, (2 * row + column) * channels, channels)
                                   : y.select(3, u).select(2, v);
      value = value.to(torch::kFloat32);
      for (const torch::Tensor& addend : addends)
        value = value + addend.select(3, u).select(2, v).to(torch::kFloat32);
      out.select(3, u).select(2, v).copy_(rectify ? value.clamp_min(0) : value);
    }
  }
  return out;
}

TEST(JoinMaps, EqualsTheSumPixelByPixel) {
  torch::manual_seed(1);
  const torch::InferenceMode guard;
  for (const torch::Dtype type : {torch::kFloat32, torch::kBFloat16, torch::kFloat64}) {
    for (const bool blocks : {false, true}) {
      const torch::Tensor y = blocks ? random_map(12, 6, 8, type) : random_map(3, 10, 14, type);
      std::vector<torch::Tensor> addends;
      for (int count = 0; count < 3; ++count) {
        for (const bool rectify : {false, true}) {
          const torch::Tensor expected = joined_by_hand(y, blocks, addends, rectify, 10, 14);
          const torch::Tensor actual = join_maps(y, blocks, addends, rectify);
          EXPECT_EQ(actual.scalar_type(), type);
          // What float32 gives, rounded once to the type.
          const double tolerance = type == torch::kFloat64 ? 1e-6 : 0;
          EXPECT_LE(
              (actual.to(torch::kFloat64) - expected.to(type).to(torch::kFloat64)).abs().max().item<double>(),
              tolerance)
              << blocks << count << rectify << type;
        }
        addends.push_back(random_map(3, 10, 14, type));
      }
    }
  }
}

TEST(JoinMaps, FillsAPartOfALargerMapAndCuts) {
  torch::manual_seed(2);
  const torch::InferenceMode guard;
  for (const torch::Dtype type : {torch::kFloat32, torch::kFloat64}) {
    const torch::Tensor y = random_map(12, 6, 8, type);
    const torch::Tensor both =
        torch::full({2, 5, 9, 13}, 7, type).contiguous(torch::MemoryFormat::ChannelsLast);
    join_maps(y, true, {}, false, both.narrow(1, 0, 3));
    EXPECT_TRUE(
        torch::equal(both.narrow(1, 0, 3).to(torch::kFloat32), joined_by_hand(y, true, {}, false, 9, 13)));
    EXPECT_TRUE(both.narrow(1, 3, 2).eq(7).all().item<bool>());
  }
}

TEST(JoinMaps, KeepsNaN) {
  const torch::InferenceMode guard;
  for (const torch::Dtype type : {torch::kFloat32, torch::kBFloat16}) {
    torch::Tensor y = random_map(3, 4, 4, type);
    y[0][1][2][3] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(join_maps(y, false, {random_map(3, 4, 4, type)}, true).isnan().sum().item<int>(), 1);
  }
}

TEST(Convolution, WithAndWithoutGradientsTheSame) {
  torch::manual_seed(3);
  for (const std::int64_t kernel : {1, 3, 7}) {
    for (const std::int64_t stride : {1, 2}) {
      const torch::Tensor x = torch::randn({1, 8, 11, 9}).contiguous(torch::MemoryFormat::ChannelsLast);
      Convolution conv(torch::nn::Conv2dOptions(8, 6, kernel).stride(stride).padding(kernel / 2));
      const torch::Tensor expected = conv->forward(x);
      const torch::NoGradGuard guard;
      EXPECT_LT((conv->forward(x) - expected).abs().max().item<double>(), 1e-5) << kernel << " " << stride;
    }
  }
}

}  // namespace
}  // namespace alight
