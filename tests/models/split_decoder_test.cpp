#include "models/split_decoder.hpp"

#include <gtest/gtest.h>

#include "models/fold_batch_norm.hpp"
#include "tests/models/tiny_net.hpp"

namespace alight {
namespace {

double largest_split_error(const torch::Tensor& actual, const torch::Tensor& expected) {
  return ((actual - expected).abs() / expected.abs()).max().item<double>();
}

std::vector<DepthCompletionConfig> every_kind() {
  std::vector<DepthCompletionConfig> configs{test::tiny_config(), test::tiny_shipped_config(),
                                             test::tiny_paper_config()};
  configs.push_back(test::tiny_shipped_config());
  configs.back().fusion = Fusion::kSum;
  configs.push_back(test::tiny_config());
  configs.back().stem = Stem::kFull;
  configs.push_back(test::tiny_shipped_config());
  configs.back().normalization = Normalization::kGroup;
  return configs;
}

TEST(SplitDecoder, DecodesAsTheNetworkDoes) {
  const torch::NoGradGuard guard;
  for (const DepthCompletionConfig& config : every_kind()) {
    DepthCompletionNet net = test::random_net(config);
    for (const bool folded : {false, true}) {
      if (folded && config.normalization == Normalization::kGroup) continue;
      if (folded) net = fold_batch_norm(net);
      SplitDecoder decoder(net);
      decoder.to(torch::kCPU, torch::kFloat32);
      // Sizes that are multiples of the encoder's stride, and not.
      for (const auto& [height, width] : {std::pair{64, 96}, std::pair{45, 75}}) {
        const SceneView view = test::random_view(2, height, width);
        const auto image = net->encode_image(view);
        const auto part = decoder.image_part(image);
        for (int step = 0; step < 2; ++step) {  // the image's part stays good for another refinement
          const auto depth = net->encode_depth(test::random_sparse_m(2, height, width), view.prior_m);
          EXPECT_LT(largest_split_error(decoder.decode(part, depth), net->decode(image, depth)), 1e-4)
              << height << " " << static_cast<int>(config.stem) << " " << folded;
        }
      }
    }
  }
}

}  // namespace
}  // namespace alight
