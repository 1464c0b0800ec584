#include "models/fold_batch_norm.hpp"

#include <gtest/gtest.h>

#include "tests/models/tiny_net.hpp"

namespace alight {
namespace {

double largest_relative_error(const torch::Tensor& actual, const torch::Tensor& expected) {
  return ((actual - expected).abs() / expected.abs()).max().item<double>();
}

TEST(FoldBatchNorm, PredictsTheSame) {
  torch::NoGradGuard no_grad;
  for (const auto& config : {test::tiny_config(), test::tiny_shipped_config(), test::tiny_paper_config()}) {
    DepthCompletionNet net = test::random_net(config);
    DepthCompletionNet folded = fold_batch_norm(net);
    EXPECT_FALSE(folded->is_training());
    const SceneView view = test::random_view(2, 45, 75);
    const torch::Tensor sparse_m = test::random_sparse_m(2, 45, 75);
    EXPECT_LT(largest_relative_error(folded->forward(view, sparse_m), net->forward(view, sparse_m)), 1e-4);
  }
}

TEST(FoldBatchNorm, LeavesNoNormalisationBehindAndTheOriginalAlone) {
  DepthCompletionNet net = test::random_net(test::tiny_config());
  const torch::Tensor before = net->parameters().front().clone();
  DepthCompletionNet folded = fold_batch_norm(net);
  for (const auto& module : folded->modules()) EXPECT_EQ(module->as<torch::nn::BatchNorm2d>(), nullptr);
  EXPECT_EQ(folded->config().normalization, Normalization::kNone);
  EXPECT_EQ(net->config().normalization, Normalization::kBatch);
  EXPECT_TRUE(torch::equal(net->parameters().front(), before));
}

TEST(FoldBatchNorm, FoldedNetworkIsCopied) {
  DepthCompletionNet folded = fold_batch_norm(test::random_net(test::tiny_paper_config()));
  DepthCompletionNet again = fold_batch_norm(folded);
  torch::NoGradGuard no_grad;
  const torch::Tensor image = torch::rand({1, 3, 32, 32});
  const torch::Tensor sparse_m = test::random_sparse_m(1, 32, 32);
  EXPECT_TRUE(torch::equal(again->forward({image}, sparse_m), folded->forward({image}, sparse_m)));
  EXPECT_NE(again->parameters().front().data_ptr(), folded->parameters().front().data_ptr());
}

TEST(FoldBatchNorm, RefusesGroupNormalisation) {
  DepthCompletionConfig config = test::tiny_config();
  config.normalization = Normalization::kGroup;
  EXPECT_THROW(fold_batch_norm(DepthCompletionNet(config)), std::invalid_argument);
}

}  // namespace
}  // namespace alight
