#include "models/inputs/stereo_cue.hpp"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

namespace alight {
namespace {

constexpr double kFocalBaseline_px_m = 35.2;

/// Smooth texture at continuous column positions: waves of 9 to 40 px.
torch::Tensor texture(const torch::Tensor& u, const torch::Tensor& v) {
  return 0.5 + 0.15 * torch::sin(0.7 * u + 0.3 * v) + 0.15 * torch::sin(0.31 * u - 0.5 * v + 1) +
         0.1 * torch::sin(0.16 * u + 0.9 * v + 2);
}

struct Pair {
  torch::Tensor left, right;
};

/// Level ground at `depth_m`: right(u - disparity) = left(u).
Pair pair_at(double depth_m, std::int64_t height = 64, std::int64_t width = 96) {
  const torch::Tensor u =
      torch::arange(width, torch::kFloat32).view({1, 1, 1, -1}).expand({1, 3, height, width});
  const torch::Tensor v =
      torch::arange(height, torch::kFloat32).view({1, 1, -1, 1}).expand({1, 3, height, width});
  return {texture(u, v), texture(u + kFocalBaseline_px_m / depth_m, v)};
}

torch::Tensor cue(const Pair& pair, double prior_m) {
  return stereo_cue(pair.left, pair.right, torch::full({1, 1, pair.left.size(2), pair.left.size(3)}, prior_m),
                    torch::full({1}, kFocalBaseline_px_m));
}

/// Mean of a channel away from the border.
double middle(const torch::Tensor& cues, std::int64_t channel) {
  return cues[0][channel].slice(0, 16, 48).slice(1, 32, 80).mean().item<double>();
}

TEST(StereoCue, TellsHowMuchNearerThanThePriorTheGroundIs) {
  // The relative change of the disparity, d / d_prior - 1 = prior / depth - 1, in proportion to the weight.
  for (const double depth_m : {9.0, 10.0, 11.0}) {
    const torch::Tensor cues = cue(pair_at(depth_m), 10);
    for (std::int64_t scale = 0; scale < 2; ++scale) {
      EXPECT_GT(middle(cues, 2 * scale + 1), 0.9);
      EXPECT_NEAR(middle(cues, 2 * scale) / middle(cues, 2 * scale + 1), 10 / depth_m - 1, 0.04) << depth_m;
    }
  }
}

TEST(StereoCue, CoarseScaleReachesFurther) {
  const torch::Tensor cues = cue(pair_at(5.5), 10);  // 2.9 px off
  EXPECT_GT(middle(cues, 4), 0.5);
}

TEST(StereoCue, SaysNothingWithoutTextureRightImageHeightOrBaseline) {
  const Pair pair = pair_at(9);
  const torch::Tensor prior_m = torch::full({1, 1, 64, 96}, 10.0);
  const torch::Tensor baseline = torch::full({1}, kFocalBaseline_px_m);
  const torch::Tensor flat = torch::full_like(pair.left, 0.5);
  for (const torch::Tensor& cues : {stereo_cue(flat, flat, prior_m, baseline),
                                    stereo_cue(pair.left, torch::zeros_like(pair.right), prior_m, baseline),
                                    stereo_cue(pair.left, pair.right, torch::zeros_like(prior_m), baseline),
                                    stereo_cue(pair.left, pair.right, prior_m, torch::zeros({1}))}) {
    EXPECT_LT(cues.abs().max().item<double>(), 1e-5);
  }
}

TEST(StereoCue, ADifferenceInBrightnessIsNoParallax) {
  Pair pair = pair_at(10);
  pair.right = pair.right + 0.1;
  EXPECT_NEAR(middle(cue(pair, 10), 0), 0, 0.01);
}

TEST(StereoCue, KeepsAnOddSizeAndRefusesWrongShapes) {
  const Pair pair = pair_at(9, 33, 47);
  EXPECT_EQ(cue(pair, 10).sizes(), (std::vector<std::int64_t>{1, kStereoCueChannels, 33, 47}));
  EXPECT_THROW(stereo_cue(pair.left, pair.right, torch::ones({1, 1, 8, 8}), torch::ones({1})),
               std::invalid_argument);
}

/// Planes in float32, tensors in float64: two ways to the same cues.
TEST(StereoCue, PlanesAndTensorsAgree) {
  torch::manual_seed(5);
  for (const auto& [height, width] : {std::pair<std::int64_t, std::int64_t>{64, 96}, {37, 51}, {8, 8}}) {
    Pair pair = pair_at(9, height, width);
    pair.left = torch::cat({pair.left, torch::rand({2, 3, height, width})});
    pair.right =
        torch::cat({pair.right, torch::rand({1, 3, height, width}), torch::zeros({1, 3, height, width})});
    const torch::Tensor prior_m = 8 + 4 * torch::rand({3, 1, height, width});
    prior_m[1].slice(1, 0, 3).zero_();
    const torch::Tensor baseline = torch::full({3}, kFocalBaseline_px_m);
    const auto as_double = [](const torch::Tensor& x) { return x.to(torch::kFloat64); };
    const torch::Tensor planes = stereo_cue(pair.left, pair.right, prior_m, baseline);
    const torch::Tensor tensors =
        stereo_cue(as_double(pair.left), as_double(pair.right), as_double(prior_m), as_double(baseline));
    EXPECT_LT((as_double(planes) - tensors).abs().max().item<double>(), 1e-3) << height << "x" << width;
    EXPECT_LT((as_double(planes) - tensors).abs().mean().item<double>(), 1e-5) << height << "x" << width;
  }
}

}  // namespace
}  // namespace alight
