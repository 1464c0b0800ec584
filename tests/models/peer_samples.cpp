#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "models/checkpoint.hpp"
#include "models/inputs/altitude_plane.hpp"
#include "tests/models/tiny_net.hpp"

/// What the Python scripts are compared with. `peer_samples FOLDER` makes, for every variant of the network, NAME.pt (a
/// checkpoint) and NAME.tensors.pt (inputs and the depth that C++ predicts). `peer_samples --image-encoder WEIGHTS OUT`
/// writes an image and what the default network's image encoder makes of it with these weights.
namespace {

using namespace alight;

std::map<std::string, DepthCompletionConfig> variants() {
  DepthCompletionConfig masked = test::tiny_config();
  masked.stem = Stem::kFull;
  masked.fusion = Fusion::kSum;
  masked.depth_input = DepthInput::kMasked;
  masked.head = Head::kDirect;
  DepthCompletionConfig group = test::tiny_config();
  group.normalization = Normalization::kGroup;
  DepthCompletionConfig none = test::tiny_config();
  none.normalization = Normalization::kNone;
  return {{"default", test::tiny_config()},         {"no_normalization", none},
          {"shipped", test::tiny_shipped_config()}, {"paper", test::tiny_paper_config()},
          {"full_stem_masked_sum", masked},         {"group_normalization", group}};
}

void write(const std::filesystem::path& folder, const std::string& name,
           const DepthCompletionConfig& config) {
  DepthCompletionNet net = test::random_net(config);
  save_checkpoint(folder / (name + ".pt"), net);
  torch::NoGradGuard no_grad;
  constexpr std::int64_t kHeight_px = 45;  // odd, so that padding and every rounding up is used
  constexpr std::int64_t kWidth_px = 75;
  SceneView view = test::random_view(2, kHeight_px, kWidth_px);
  const torch::Tensor height_m = torch::tensor({18.0, std::nan("")}, torch::kFloat64);
  const torch::Tensor down = torch::tensor({{0.1, -0.2, 0.97}, {0.0, 0.0, 1.0}}, torch::kFloat64);
  const torch::Tensor intrinsics_px = torch::tensor({{60.0, 62.0, 37.0, 22.0}}).repeat({2, 1});
  view.prior_m = altitude_planes(height_m, down, intrinsics_px, kHeight_px, kWidth_px, config.max_depth_m);
  torch::Tensor sparse_m = test::random_sparse_m(2, kHeight_px, kWidth_px);
  torch::serialize::OutputArchive archive;
  archive.write("left", view.left);
  archive.write("right", view.right);
  archive.write("focal_baseline_px_m", view.focal_baseline_px_m);
  archive.write("height_m", height_m);
  archive.write("down_camera", down);
  archive.write("intrinsics_px", intrinsics_px);
  archive.write("prior_m", view.prior_m);
  archive.write("sparse_m", sparse_m);
  archive.write("depth_m", net->forward(view, sparse_m));
  archive.write("depth_without_points_m", net->forward(view, torch::zeros_like(sparse_m)));
  archive.write("depth_of_left_alone_m", net->forward({view.left}, sparse_m));
  net->train();
  archive.write("depth_in_training_m", net->forward(view, sparse_m));
  archive.save_to((folder / (name + ".tensors.pt")).string());
}

void write_image_features(const std::filesystem::path& weights, const std::string& out) {
  torch::manual_seed(5);
  DepthCompletionNet net;
  load_image_encoder(weights, net);
  net->eval();
  torch::NoGradGuard no_grad;
  const torch::Tensor left = torch::rand({1, 3, 64, 96});
  torch::serialize::OutputArchive archive;
  archive.write("left", left);
  const auto features = net->image_features(left);
  for (std::size_t i = 0; i < features.size(); ++i)
    archive.write("features_" + std::to_string(i + 1), features[i]);
  archive.save_to(out);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 4 && std::string(argv[1]) == "--image-encoder") {
    write_image_features(argv[2], argv[3]);
    return 0;
  }
  if (argc != 2) {
    std::fputs("usage: peer_samples FOLDER | --image-encoder WEIGHTS OUT\n", stderr);
    return 2;
  }
  std::filesystem::create_directories(argv[1]);
  for (const auto& [name, config] : variants()) write(argv[1], name, config);
  return 0;
}
