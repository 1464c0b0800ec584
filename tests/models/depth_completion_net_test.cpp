#include "models/depth_completion_net.hpp"

#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "tests/models/tiny_net.hpp"

namespace alight {
namespace {

using test::random_sparse_m;
using test::random_view;
using test::tiny_config;

struct Variant {
  const char* name;
  Stem stem;
  Normalization normalization;
  Fusion fusion;
  DepthInput depth_input;
  Head head;
  Prior prior = Prior::kConstant;
  bool stereo = false;
  int detail_width = 0;
};

class DepthCompletionNetVariants : public testing::TestWithParam<Variant> {
 protected:
  static DepthCompletionConfig config() {
    DepthCompletionConfig c = tiny_config();
    c.stem = GetParam().stem;
    c.normalization = GetParam().normalization;
    c.fusion = GetParam().fusion;
    c.depth_input = GetParam().depth_input;
    c.head = GetParam().head;
    c.prior = GetParam().prior;
    c.stereo = GetParam().stereo;
    c.detail_width = GetParam().detail_width;
    return c;
  }
};

TEST_P(DepthCompletionNetVariants, AnySizeGivesBoundedDepthOfThatSize) {
  torch::manual_seed(1);
  DepthCompletionNet net(config());
  net->eval();
  torch::NoGradGuard no_grad;
  for (const auto& [height, width] : {std::pair<int, int>{32, 64}, {33, 47}, {9, 40}}) {
    const torch::Tensor depth_m =
        net->forward({torch::rand({2, 3, height, width})}, random_sparse_m(2, height, width));
    ASSERT_EQ(depth_m.sizes(), (std::vector<std::int64_t>{2, 1, height, width}));
    EXPECT_GE(depth_m.min().item<double>(), net->config().min_depth_m * (1 - 1e-6));
    EXPECT_LE(depth_m.max().item<double>(), net->config().max_depth_m * (1 + 1e-6));
  }
}

TEST_P(DepthCompletionNetVariants, EveryParameterGetsAGradient) {
  torch::manual_seed(2);
  DepthCompletionNet net(config());
  const torch::Tensor sparse_m = random_sparse_m(2, 64, 64);
  net->forward(random_view(2, 64, 64), sparse_m).log().square().mean().backward();
  for (const auto& item : net->named_parameters()) {
    ASSERT_TRUE(item.value().grad().defined()) << item.key();
    EXPECT_TRUE(item.value().grad().isfinite().all().item<bool>()) << item.key();
    EXPECT_GT(item.value().grad().abs().max().item<double>(), 0) << item.key();
  }
}

TEST_P(DepthCompletionNetVariants, SplitPassesEqualForward) {
  torch::manual_seed(3);
  DepthCompletionNet net(config());
  net->eval();
  torch::NoGradGuard no_grad;
  const SceneView view = random_view(1, 40, 40);
  const auto image_pyramid = net->encode_image(view);
  for (int i = 0; i < 2; ++i) {
    const torch::Tensor sparse_m = random_sparse_m(1, 40, 40);
    EXPECT_TRUE(torch::equal(net->decode(image_pyramid, net->encode_depth(sparse_m, view.prior_m)),
                             net->forward(view, sparse_m)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, DepthCompletionNetVariants,
    testing::Values(Variant{"Default", Stem::kDownsample, Normalization::kBatch, Fusion::kConcatenate,
                            DepthInput::kFilled, Head::kGated},
                    Variant{"Shipped", Stem::kDownsample, Normalization::kBatch, Fusion::kConcatenate,
                            DepthInput::kFilled, Head::kGated, Prior::kAltitude, true, 4},
                    Variant{"Paper", Stem::kDownsample, Normalization::kBatch, Fusion::kConcatenate,
                            DepthInput::kRaw, Head::kDirect},
                    Variant{"FullStemSum", Stem::kFull, Normalization::kBatch, Fusion::kSum,
                            DepthInput::kMasked, Head::kDirect},
                    Variant{"GroupNormalization", Stem::kDownsample, Normalization::kGroup, Fusion::kSum,
                            DepthInput::kFilled, Head::kGated}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(DepthCompletionNet, GateIsShutWithoutPoints) {
  torch::manual_seed(4);
  DepthCompletionNet net(tiny_config());
  net->eval();
  torch::NoGradGuard no_grad;
  for (auto& item : net->named_parameters()) {
    if (item.key() == "head.weight") item.value().zero_();
    if (item.key() == "head.bias") item.value().copy_(torch::tensor({0.0F, 50.0F, 0.0F}));  // gate wide open
  }
  const torch::Tensor image = torch::rand({2, 3, 32, 32});
  torch::Tensor sparse_m = torch::zeros({2, 1, 32, 32});
  sparse_m[1].fill_(12);
  const torch::Tensor depth_m = net->forward({image}, sparse_m);
  const double prior_m = net->config().depth_scale_m;
  EXPECT_TRUE(torch::allclose(depth_m[0], torch::full({1, 32, 32}, prior_m), 1e-4, 0));
  EXPECT_TRUE(torch::allclose(depth_m[1], torch::full({1, 32, 32}, 12.0), 1e-4, 0));
}

TEST(DepthCompletionNet, AltitudePlaneIsTheFirstGuessWithoutPoints) {
  torch::manual_seed(4);
  DepthCompletionConfig config = tiny_config();
  config.prior = Prior::kAltitude;
  DepthCompletionNet net(config);
  net->eval();
  torch::NoGradGuard no_grad;
  for (auto& item : net->named_parameters()) {
    if (item.key().rfind("head.", 0) == 0) item.value().zero_();
  }
  SceneView view{torch::rand({2, 3, 32, 32})};
  view.prior_m = 30 + torch::rand({2, 1, 32, 32});
  view.prior_m[1].zero_();  // height unknown
  const torch::Tensor depth_m = net->forward(view, torch::zeros({2, 1, 32, 32}));
  EXPECT_TRUE(torch::allclose(depth_m[0], view.prior_m[0], 1e-4, 0));
  EXPECT_TRUE(torch::allclose(depth_m[1], torch::full({1, 32, 32}, config.depth_scale_m), 1e-4, 0));
}

TEST(DepthCompletionNet, RightImageMattersToAStereoNetworkAlone) {
  for (const bool stereo : {false, true}) {
    torch::manual_seed(7);
    DepthCompletionConfig config = tiny_config();
    config.prior = Prior::kAltitude;
    config.stereo = stereo;
    DepthCompletionNet net(config);
    net->eval();
    torch::NoGradGuard no_grad;
    SceneView view = random_view(1, 32, 32);
    const torch::Tensor with_right = net->forward(view, torch::zeros({1, 1, 32, 32}));
    view.right = torch::zeros_like(view.right);
    EXPECT_EQ(torch::equal(net->forward(view, torch::zeros({1, 1, 32, 32})), with_right), !stereo);
  }
}

TEST(DepthCompletionNet, ImageAndPointsBothMatter) {
  torch::manual_seed(5);
  DepthCompletionNet net(tiny_config());
  net->eval();
  torch::NoGradGuard no_grad;
  const torch::Tensor image = torch::rand({1, 3, 32, 32});
  const torch::Tensor sparse_m = random_sparse_m(1, 32, 32);
  const torch::Tensor depth_m = net->forward({image}, sparse_m);
  EXPECT_FALSE(torch::equal(depth_m, net->forward({1 - image}, sparse_m)));
  EXPECT_FALSE(torch::equal(depth_m, net->forward({image}, sparse_m * 0)));
}

TEST(DepthCompletionNet, ChannelsLastComputesTheSame) {
  for (const Normalization normalization : {Normalization::kBatch, Normalization::kGroup}) {
    torch::manual_seed(6);
    DepthCompletionConfig config = tiny_config();
    config.normalization = normalization;
    DepthCompletionNet net(config);
    net->eval();
    torch::NoGradGuard no_grad;
    const torch::Tensor image = torch::rand({2, 3, 40, 40});
    const torch::Tensor sparse_m = random_sparse_m(2, 40, 40);
    const torch::Tensor expected = net->forward({image}, sparse_m);
    for (torch::Tensor& parameter : net->parameters()) {
      if (parameter.dim() == 4) parameter.set_data(parameter.contiguous(torch::MemoryFormat::ChannelsLast));
    }
    EXPECT_TRUE(torch::allclose(net->forward({image.contiguous(torch::MemoryFormat::ChannelsLast)}, sparse_m),
                                expected, 1e-4, 1e-4));
  }
}

TEST(DepthCompletionNet, RefusesWrongShapes) {
  DepthCompletionNet net(tiny_config());
  net->eval();
  EXPECT_THROW(net->encode_image({torch::rand({1, 1, 32, 32})}), std::invalid_argument);
  EXPECT_THROW(net->encode_depth(torch::rand({1, 32, 32})), std::invalid_argument);
  EXPECT_THROW(net->decode(net->encode_image({torch::rand({1, 3, 64, 64})}),
                           net->encode_depth(torch::rand({1, 1, 32, 32}))),
               std::invalid_argument);
}

TEST(DepthCompletionConfig, RefusesPartsThatDoNotFit) {
  for (const char* text : {"fusion: sum", "image_widths: [64, 128]", "decoder_widths: [8, 8, 8, 8, 0]",
                           "{min_depth_m: 3, max_depth_m: 2}", "{head: gated, depth_input: raw}",
                           "{prior: altitude, head: direct}", "stereo: true",
                           "{stereo: true, prior: altitude, depth_kind: perspective}"}) {
    EXPECT_THROW(parse_config<DepthCompletionConfig>(text, "test"), ConfigError) << text;
  }
  DepthCompletionConfig config = tiny_config();
  config.depth_widths = {4};
  EXPECT_THROW(DepthCompletionNet{config}, std::invalid_argument);
}

TEST(DepthCompletionConfig, PrintsAndReadsBack) {
  DepthCompletionConfig config = tiny_config();
  config.depth_kind = DepthKind::kPerspective;
  config.head = Head::kDirect;
  const std::string text = print_config(config);
  EXPECT_EQ(print_config(parse_config<DepthCompletionConfig>(text, "printed")), text);
}

}  // namespace
}  // namespace alight
