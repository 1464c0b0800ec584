#include "train/evaluation/methods/network_method.hpp"

#include <gtest/gtest.h>

#include "models/depth_conversion.hpp"
#include "tests/train/evaluation/evaluation_scenes.hpp"

namespace alight {
namespace {

LoadedNetwork small_network(DepthKind kind) {
  torch::manual_seed(3);
  DepthCompletionConfig config;
  config.image_widths = {8, 8, 16, 16};
  config.depth_widths = {8, 8, 8, 8};
  config.decoder_widths = {16, 8, 8, 8, 8};
  config.depth_kind = kind;
  return {DepthCompletionNet(config), config, {}};
}

/// The network of a perspective model reads and predicts ranges; the method speaks plane depth. It shows the network
/// both cameras, and what a camera that looks straight down sees of level ground: the height, everywhere.
TEST(NetworkMethod, PredictsPlaneDepthWhateverTheNetworkLearned) {
  DepthSample sample = test::scene_sample(0);
  sample.right = test::random_image(48, 48);
  for (const DepthKind kind : {DepthKind::kPlane, DepthKind::kPerspective}) {
    LoadedNetwork network = small_network(kind);
    const torch::Tensor depth_m = make_network_method("net", network)->complete(sample, sample.sparse);
    ASSERT_EQ(depth_m.sizes(), sample.sparse.sizes());
    EXPECT_FALSE(depth_m.requires_grad());
    EXPECT_FALSE(network.net->is_training());
    const torch::Tensor lengths = ray_lengths(sample.intrinsics.unsqueeze(0), 48, 48);
    const torch::Tensor scale = kind == DepthKind::kPlane ? torch::ones_like(lengths) : lengths;
    const SceneView view{sample.left.unsqueeze(0), sample.right.unsqueeze(0), sample.height_m * scale,
                         torch::tensor({40 * 0.01F})};
    const torch::Tensor network_m = network.net->forward(view, sample.sparse.unsqueeze(0) * scale);
    EXPECT_TRUE(torch::allclose(depth_m, (network_m / scale).squeeze(0), 1e-5));
  }
}

}  // namespace
}  // namespace alight
