#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>

#include "foundation/config_reader.hpp"
#include "models/checkpoint.hpp"
#include "tests/models/tiny_net.hpp"
#include "tests/train/data/ground_scene.hpp"
#include "train/network_pass.hpp"
#include "train/train_config.hpp"

/// What the Python step of scripts/bench/train.py is compared with. `step_samples FOLDER` makes, for every choice of
/// losses, NAME.pt (weights and configuration) and NAME.tensors.pt: a batch, what is fed of it, the prediction, the loss
/// terms and the norm of the gradient.
namespace {

using namespace alight;

/// Two tilted views of ground, the second without right image.
Batch two_samples() {
  test::GroundSceneOptions second;
  second.has_right = false;
  const Batch a = test::ground_scene().batch;
  const Batch b = test::ground_scene(second).batch;
  Batch both;
  for (const auto field : {&Batch::left, &Batch::right, &Batch::previous, &Batch::next, &Batch::sparse_m,
                           &Batch::offset_s, &Batch::has_right, &Batch::has_previous, &Batch::has_next,
                           &Batch::T_previous_camera, &Batch::T_next_camera, &Batch::intrinsics_px,
                           &Batch::baseline_m, &Batch::height_m, &Batch::down_camera}) {
    both.*field = torch::cat({a.*field, b.*field});
  }
  both.offset_s = torch::rand_like(both.sparse_m) - 0.5;
  both.sparse_m = both.sparse_m * (1 + 0.2 * torch::rand_like(both.sparse_m));  // some hide others
  both.has_previous[1] = false;
  return both;
}

void write(const std::filesystem::path& folder, const std::string& name, const TrainConfig& config) {
  DepthCompletionNet net = test::random_net(config.model);
  CheckpointInfo info;
  info.train_config = print_config(config);
  save_checkpoint(folder / (name + ".pt"), net, info);
  net->train();
  torch::manual_seed(6);
  const Batch batch = two_samples();
  const NetworkInput input{batch.left, batch.right, batch.sparse_m * (torch::rand_like(batch.sparse_m) < 0.5),
                           torch::tensor({true, false})};
  const torch::Tensor prediction_m = predict(net, batch, input);
  const torch::Tensor ground_truth_m =
      drop_hidden_points(batch.sparse_m, batch.offset_s, config.occlusion_filter);
  const LossTerms terms = TrainingLoss(config.loss)(loss_inputs(batch, input, prediction_m, ground_truth_m));
  terms.total.backward();
  double square = 0;
  for (const torch::Tensor& p : net->parameters()) square += p.grad().square().sum().item<double>();
  torch::serialize::OutputArchive archive;
  const std::pair<const char*, torch::Tensor> tensors[] = {
      {"left", batch.left},
      {"right", batch.right},
      {"previous", batch.previous},
      {"next", batch.next},
      {"sparse_m", batch.sparse_m},
      {"offset_s", batch.offset_s},
      {"has_right", batch.has_right},
      {"has_previous", batch.has_previous},
      {"has_next", batch.has_next},
      {"T_previous_camera", batch.T_previous_camera},
      {"T_next_camera", batch.T_next_camera},
      {"intrinsics_px", batch.intrinsics_px},
      {"baseline_m", batch.baseline_m},
      {"height_m", batch.height_m},
      {"down_camera", batch.down_camera},
      {"input_m", input.sparse_m},
      {"knows_height", input.knows_height},
      {"prediction_m", prediction_m.detach()},
      {"depth", terms.depth.detach()},
      {"ratio", terms.ratio.detach()},
      {"photometric", terms.photometric.detach()},
      {"smoothness", terms.smoothness.detach()},
      {"total", terms.total.detach()},
      {"gradient_norm", torch::tensor(std::sqrt(square))}};
  for (const auto& [key, tensor] : tensors) archive.write(key, tensor.contiguous());
  archive.save_to((folder / (name + ".tensors.pt")).string());
}

TrainConfig paper() {
  TrainConfig config;
  config.model = test::tiny_paper_config();
  return config;
}

/// All that the paper's losses leave off.
TrainConfig shipped() {
  TrainConfig config;
  config.model = test::tiny_shipped_config();
  config.loss.depth_error = DepthError::kRmse;
  config.loss.target = LossTarget::kHeldOut;
  config.loss.photometric.reduction = PhotometricReduction::kMin;
  config.loss.smoothness.edge_aware = true;
  config.loss.smoothness.relative = true;
  config.occlusion_filter.window_px = 9;
  return config;
}

TrainConfig self_supervised() {
  TrainConfig config;
  config.model = test::tiny_config();
  config.loss.depth_error = DepthError::kLog;
  config.loss.target = LossTarget::kInput;
  config.loss.photometric.use_next = false;
  config.loss.smoothness_weight = 0;
  return config;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: step_samples FOLDER\n", stderr);
    return 2;
  }
  std::filesystem::create_directories(argv[1]);
  write(argv[1], "paper", paper());
  write(argv[1], "shipped", shipped());
  write(argv[1], "self_supervised", self_supervised());
  return 0;
}
