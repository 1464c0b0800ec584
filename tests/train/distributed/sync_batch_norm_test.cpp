#include "train/distributed/sync_batch_norm.hpp"

#include <gtest/gtest.h>

#include "models/depth_completion_net.hpp"
#include "tests/models/tiny_net.hpp"
#include "tests/train/distributed/thread_group.hpp"

namespace alight {
namespace {

using test::in_group;

SumOverProcesses sum_of(const ProcessGroup& group) {
  return [group](torch::Tensor& x) { group.all_reduce_sum({x}); };
}

/// Values far from zero, whose variance is lost where squares are added up in float32.
torch::Tensor batch() {
  torch::manual_seed(3);
  return 300 + torch::randn({4, 3, 5, 7}) * torch::tensor({1.0F, 0.1F, 4.0F}).view({1, 3, 1, 1});
}

/// Draws from torch's one generator: not for use in several threads at once.
torch::nn::BatchNorm2d plain_norm() {
  torch::manual_seed(4);
  torch::nn::BatchNorm2d norm(3);
  const torch::NoGradGuard no_grad;
  norm->weight.copy_(torch::randn({3}));
  norm->bias.copy_(torch::randn({3}));
  norm->running_mean.copy_(torch::randn({3}));
  return norm;
}

/// Every process's batch counts, not every process: one has three samples, the other one.
TEST(SyncBatchNorm, EqualsBatchNormOverTheWholeBatch) {
  const torch::Tensor whole = batch().requires_grad_();
  const torch::Tensor slope = torch::randn({4, 3, 5, 7});
  torch::nn::BatchNorm2d plain = plain_norm();
  const torch::Tensor y = plain->forward(whole);
  (y * slope).sum().backward();
  plain->eval();
  const torch::Tensor y_in_use = plain->forward(whole.detach());
  const std::vector<torch::nn::BatchNorm2d> copies{plain_norm(), plain_norm()};
  std::vector<torch::Tensor> d_weight(2), d_bias(2);
  in_group(2, [&](const ProcessGroup& group) {
    const std::int64_t begin = group.rank() == 0 ? 0 : 3;
    const std::int64_t end = group.rank() == 0 ? 3 : 4;
    torch::Tensor part = whole.detach().slice(0, begin, end).clone().requires_grad_();
    SyncBatchNormImpl norm(*copies[static_cast<std::size_t>(group.rank())], sum_of(group));
    const torch::Tensor y_part = norm.forward(part);
    (y_part * slope.slice(0, begin, end)).sum().backward();
    EXPECT_TRUE(torch::allclose(y_part, y.slice(0, begin, end), 1e-4, 1e-4));
    EXPECT_TRUE(torch::allclose(part.grad(), whole.grad().slice(0, begin, end), 1e-3, 1e-4));
    EXPECT_TRUE(torch::allclose(norm.named_buffers()["running_mean"], plain->running_mean, 1e-6, 1e-6));
    EXPECT_TRUE(torch::allclose(norm.named_buffers()["running_var"], plain->running_var, 1e-5, 1e-6));
    EXPECT_EQ(norm.named_buffers()["num_batches_tracked"].item<std::int64_t>(), 1);
    d_weight[static_cast<std::size_t>(group.rank())] = norm.named_parameters()["weight"].grad();
    d_bias[static_cast<std::size_t>(group.rank())] = norm.named_parameters()["bias"].grad();
    norm.eval();
    EXPECT_TRUE(torch::allclose(norm.forward(part), y_in_use.slice(0, begin, end), 1e-5, 1e-5));
  });
  EXPECT_TRUE(torch::allclose(d_weight[0] + d_weight[1], plain->weight.grad(), 1e-3, 1e-3));
  EXPECT_TRUE(torch::allclose(d_bias[0] + d_bias[1], plain->bias.grad(), 1e-4, 1e-4));
}

TEST(SyncBatchNorm, KeepsTheLowPrecisionOfItsInput) {
  SyncBatchNormImpl norm(*plain_norm(), [](torch::Tensor&) {});
  torch::Tensor x = torch::randn({2, 3, 4, 4}).to(torch::kBFloat16).requires_grad_();
  const torch::Tensor y = norm.forward(x);
  y.to(torch::kFloat32).square().sum().backward();
  EXPECT_EQ(y.scalar_type(), torch::kBFloat16);
  EXPECT_EQ(x.grad().scalar_type(), torch::kBFloat16);
  EXPECT_EQ(norm.named_parameters()["weight"].grad().scalar_type(), torch::kFloat32);
}

TEST(SyncBatchNorm, ReplacesAllOfANetworkUnderTheSameNames) {
  torch::manual_seed(1);
  DepthCompletionNet plain(test::tiny_shipped_config());
  torch::manual_seed(1);
  DepthCompletionNet net(test::tiny_shipped_config());
  int sums = 0;
  synchronize_batch_norms(*net, [&](torch::Tensor&) { ++sums; });
  const auto expect_same = [](const auto& a, const auto& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].key(), b[i].key());
      EXPECT_TRUE(torch::equal(a[i].value(), b[i].value())) << a[i].key();
    }
  };
  expect_same(net->named_parameters(), plain->named_parameters());
  expect_same(net->named_buffers(), plain->named_buffers());
  int norms = 0;
  for (const auto& module : plain->modules())
    norms += module->as<torch::nn::BatchNorm2d>() != nullptr ? 1 : 0;
  net->forward(test::random_view(2, 32, 32), test::random_sparse_m(2, 32, 32)).sum().backward();
  EXPECT_GT(norms, 0);
  EXPECT_EQ(sums, 2 * norms) << "one forward and one backward";
  for (const auto& item : net->named_parameters()) EXPECT_TRUE(item.value().grad().defined()) << item.key();
}

}  // namespace
}  // namespace alight
