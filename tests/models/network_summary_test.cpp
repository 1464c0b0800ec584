#include "models/network_summary.hpp"

#include <gtest/gtest.h>

#include "tests/models/tiny_net.hpp"

namespace alight {
namespace {

double sum_gflop(const std::vector<LayerCost>& layers) {
  double sum = 0;
  for (const LayerCost& layer : layers) sum += layer.gflop;
  return sum;
}

TEST(NetworkSummary, DefaultNetworkFitsTheOnboardBudget) {
  DepthCompletionNet net;
  EXPECT_LE(sum_gflop(measure_layers(net, 352, 352)), 20.0);
}

TEST(NetworkSummary, CountsTheStemAsComputedByHand) {
  DepthCompletionNet net(test::tiny_config());
  const auto layers = measure_layers(net, 64, 96);
  const LayerCost& stem = layers.front();
  EXPECT_EQ(stem.name, "image_encoder.stem.conv");
  EXPECT_EQ(stem.part, "image_encoder");
  EXPECT_EQ(stem.output, "[1, 4, 32, 48]");
  EXPECT_EQ(stem.parameters, 4 * 3 * 7 * 7);
  EXPECT_NEAR(stem.gflop, 2e-9 * 4 * 3 * 7 * 7 * 32 * 48, 1e-15);
}

TEST(NetworkSummary, ListsEveryConvolutionOnce) {
  DepthCompletionNet net(test::tiny_config());
  std::set<std::string> names;
  for (const LayerCost& layer : measure_layers(net, 64, 64))
    EXPECT_TRUE(names.insert(layer.name).second) << layer.name;
  std::size_t convolutions = 0;
  for (const auto& module : net->modules()) convolutions += module->as<torch::nn::Conv2d>() != nullptr;
  EXPECT_EQ(names.size(), convolutions);
  EXPECT_TRUE(net->is_training());
}

TEST(NetworkSummary, TableSaysTheTotal) {
  DepthCompletionNet net(test::tiny_config());
  std::int64_t parameters = 0;
  for (const auto& p : net->parameters()) parameters += p.numel();
  EXPECT_NE(describe_network(net, 64, 64).find(std::to_string(parameters)), std::string::npos);
}

}  // namespace
}  // namespace alight
