#include "train/optimizer.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace alight {
namespace {

/// One matrix of ones and a bias of ones.
torch::nn::Linear ones() {
  torch::nn::Linear layer(2, 2);
  const torch::NoGradGuard no_grad;
  for (torch::Tensor& parameter : layer->parameters()) parameter.fill_(1);
  return layer;
}

void set_gradients(torch::nn::Linear& layer, float value) {
  for (torch::Tensor& parameter : layer->parameters())
    parameter.mutable_grad() = torch::full_like(parameter, value);
}

TEST(Optimizer, FirstAdamStepIsTheLearningRate) {
  torch::nn::Linear layer = ones();
  Optimizer optimizer(*layer, {});
  set_gradients(layer, 5);
  EXPECT_EQ(optimizer.step(0.1), 0);
  EXPECT_NEAR(layer->weight[0][0].item<float>(), 0.9, 1e-5);
  EXPECT_NEAR(layer->bias[0].item<float>(), 0.9, 1e-5);
}

TEST(Optimizer, AdamWDecaysWeightsButNotBiases) {
  torch::nn::Linear layer = ones();
  OptimizerConfig config;
  config.kind = OptimizerKind::kAdamW;
  config.weight_decay = 0.5;
  Optimizer optimizer(*layer, config);
  set_gradients(layer, 0);
  optimizer.step(0.1);
  EXPECT_NEAR(layer->weight[0][0].item<float>(), 0.95, 1e-6);
  EXPECT_EQ(layer->bias[0].item<float>(), 1);
}

TEST(Optimizer, LongGradientsAreShortened) {
  torch::nn::Linear layer = ones();
  OptimizerConfig config;
  config.clip_gradient_norm = 1;
  Optimizer optimizer(*layer, config);
  set_gradients(layer, 10);
  EXPECT_NEAR(optimizer.step(0.1), 10 * std::sqrt(6.0), 1e-3);
  double square = 0;
  for (const torch::Tensor& parameter : layer->parameters())
    square += parameter.grad().square().sum().item<double>();
  EXPECT_NEAR(square, 1, 1e-4);
}

TEST(WeightAverage, FollowsFasterAtFirstAndCopiesBuffers) {
  torch::nn::BatchNorm2d average(3), current(3);
  const torch::NoGradGuard no_grad;
  average->weight.fill_(0);
  current->weight.fill_(1);
  current->running_mean.fill_(7);
  update_average(*average, *current, 0.9, 0);  // d = 1 / 10
  EXPECT_NEAR(average->weight[0].item<float>(), 0.9, 1e-6);
  EXPECT_EQ(average->running_mean[0].item<float>(), 7);
  average->weight.fill_(0);
  update_average(*average, *current, 0.9, 100'000);
  EXPECT_NEAR(average->weight[0].item<float>(), 0.1, 1e-6);
}

}  // namespace
}  // namespace alight
