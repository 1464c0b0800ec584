#include "losses/photometric_loss.hpp"

#include <gtest/gtest.h>

#include "tests/losses/numerical_gradient.hpp"

namespace alight {
namespace {

constexpr std::int64_t kHeight = 9;
constexpr std::int64_t kWidth = 13;

torch::Tensor intrinsics(std::int64_t batch = 1) {
  return torch::tensor({{10.0, 10.0, 6.0, 4.0}}, torch::kFloat64).repeat({batch, 1});
}

PhotometricSource source(const torch::Tensor& image, double shift_m, bool present = true) {
  torch::Tensor T = torch::eye(4, torch::kFloat64).repeat({image.size(0), 1, 1});
  T.select(1, 0).select(1, 3).fill_(shift_m);
  return {image, T, torch::full({image.size(0)}, present, torch::kBool)};
}

torch::Tensor constant(double value) { return torch::full({1, 3, kHeight, kWidth}, value, torch::kFloat64); }
torch::Tensor depth(double value = 4) { return torch::full({1, 1, kHeight, kWidth}, value, torch::kFloat64); }

/// Of two constant images: no structure, so SSIM is its brightness term.
double constant_error(double a, double b) {
  const double ssim = (2 * a * b + 1e-4) / (a * a + b * b + 1e-4);
  return 0.85 * (1 - ssim) / 2 + 0.15 * std::abs(a - b);
}

TEST(PhotometricLoss, ConstantImagesByHand) {
  const double loss =
      photometric_loss(constant(0.2), depth(), intrinsics(), {source(constant(0.6), 0.1)}, {}).item<double>();
  EXPECT_NEAR(loss, constant_error(0.2, 0.6), 1e-9);
}

TEST(PhotometricLoss, MeanAndMinimumOverTheSources) {
  const std::vector<PhotometricSource> sources{source(constant(0.6), 0.1), source(constant(0.3), -0.1)};
  PhotometricLossConfig config;
  const double a = constant_error(0.2, 0.6);
  const double b = constant_error(0.2, 0.3);
  EXPECT_NEAR(photometric_loss(constant(0.2), depth(), intrinsics(), sources, config).item<double>(),
              (a + b) / 2, 1e-9);
  // A shift of 0.25 px: 12 of 13 columns see source 1, another 12 see source 2, 11 see both.
  config.reduction = PhotometricReduction::kMin;
  EXPECT_NEAR(photometric_loss(constant(0.2), depth(), intrinsics(), sources, config).item<double>(),
              (12 * b + 1 * a) / 13, 1e-9);
}

TEST(PhotometricLoss, AbsentSourcesDoNotCount) {
  const double only =
      photometric_loss(constant(0.2), depth(), intrinsics(), {source(constant(0.6), 0.1)}, {}).item<double>();
  const double with_absent =
      photometric_loss(constant(0.2), depth(), intrinsics(),
                       {source(constant(0.6), 0.1), source(constant(0.9), 0.1, false)}, {})
          .item<double>();
  EXPECT_DOUBLE_EQ(with_absent, only);

  PhotometricSource mixed = source(torch::cat({constant(0.6), constant(0.9)}), 0.1);
  mixed.present[1] = false;
  const double batch = photometric_loss(torch::cat({constant(0.2), constant(0.2)}),
                                        depth().repeat({2, 1, 1, 1}), intrinsics(2), {mixed}, {})
                           .item<double>();
  EXPECT_NEAR(batch, only, 1e-12);
}

class PhotometricReductions : public testing::TestWithParam<PhotometricReduction> {
 protected:
  static PhotometricLossConfig config() {
    PhotometricLossConfig c;
    c.reduction = GetParam();
    return c;
  }
};

TEST_P(PhotometricReductions, NoPixelIsZeroWithZeroGradient) {
  const std::vector<std::vector<PhotometricSource>> cases{
      {}, {source(constant(0.6), 0.1, false)}, {source(constant(0.6), 1000.0)}};
  for (const auto& sources : cases) {
    const auto loss = [&](const torch::Tensor& d) {
      return photometric_loss(constant(0.2), d, intrinsics(), sources, config());
    };
    EXPECT_EQ(loss(depth()).item<double>(), 0);
    EXPECT_TRUE(torch::equal(test::autograd_gradient(loss, depth()), torch::zeros_like(depth())));
  }
}

TEST_P(PhotometricReductions, TrueDepthIsTheMinimum) {
  torch::manual_seed(3);
  // 0.8 m at 4 m and f = 10 px: the source is the target moved by 2 px.
  const torch::Tensor target = torch::rand({1, 3, kHeight, kWidth}, torch::kFloat64);
  const PhotometricSource shifted = source(torch::roll(target, 2, 3), 0.8);
  const auto loss = [&](double depth_m) {
    return photometric_loss(target, depth(depth_m), intrinsics(), {shifted}, config()).item<double>();
  };
  EXPECT_LT(loss(4), 0.05);
  EXPECT_GT(loss(3), 3 * loss(4));
  EXPECT_GT(loss(6), 3 * loss(4));
}

TEST_P(PhotometricReductions, GradientIsThatOfCentralDifferences) {
  torch::manual_seed(5);
  const torch::Tensor target = torch::rand({1, 3, 5, 7}, torch::kFloat64);
  const torch::Tensor start = 4 + torch::rand({1, 1, 5, 7}, torch::kFloat64);
  const std::vector<PhotometricSource> sources{source(torch::rand_like(target), 0.37),
                                               source(torch::rand_like(target), -0.41)};
  const auto loss = [&](const torch::Tensor& d) {
    return photometric_loss(target, d, intrinsics(), sources, config());
  };
  EXPECT_LT(test::gradient_error(loss, start), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Both, PhotometricReductions,
                         testing::Values(PhotometricReduction::kMean, PhotometricReduction::kMin));

}  // namespace
}  // namespace alight
