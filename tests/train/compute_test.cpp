#include "train/compute.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "foundation/errors.hpp"

namespace alight {
namespace {

TEST(Compute, FindsTheDevicesThatThereAre) {
  EXPECT_TRUE(find_device("cpu").is_cpu());
  EXPECT_EQ(find_device("auto").is_cuda(), torch::cuda::is_available());
  EXPECT_THROW(find_device("gpu"), ConfigError);
  if (!torch::cuda::is_available()) {
    EXPECT_THROW(find_device("cuda:0"), ConfigError);
  }
}

TEST(Compute, ProcessesOfAMachineShareItsCores) {
  const int before = at::get_num_threads();
  set_threads(0);
  const int cores = at::get_num_threads();
  set_threads(0, 2);
  EXPECT_EQ(at::get_num_threads(), std::max(1, cores / 2));
  set_threads(0, 1000 * cores);
  EXPECT_EQ(at::get_num_threads(), 1);
  set_threads(3, 2);
  EXPECT_EQ(at::get_num_threads(), 3) << "what the user sets is for each of them";
  set_threads(before);
}

TEST(Compute, PrecisionHoldsInsideTheScopeOnly) {
  const torch::Tensor image = torch::rand({1, 4, 8, 8});
  const torch::Tensor weight = torch::rand({4, 4, 3, 3});
  const auto type = [&] { return torch::conv2d(image, weight).scalar_type(); };
  {
    const PrecisionScope scope(Precision::kBfloat16, torch::kCPU);
    EXPECT_EQ(type(), torch::kBFloat16);
  }
  EXPECT_EQ(type(), torch::kFloat32);
  const PrecisionScope scope(Precision::kFloat32, torch::kCPU);
  EXPECT_EQ(type(), torch::kFloat32);
}

TEST(Compute, PlacesWeightsInTheFormat) {
  torch::nn::Conv2d conv(4, 8, 3);
  const torch::Tensor before = conv->weight.detach().clone();
  place(*conv, torch::kCPU, MemoryFormat::kChannelsLast);
  EXPECT_TRUE(conv->weight.is_contiguous(torch::MemoryFormat::ChannelsLast));
  EXPECT_TRUE(torch::equal(conv->weight, before));
  EXPECT_TRUE(conv->weight.requires_grad());
}

}  // namespace
}  // namespace alight
