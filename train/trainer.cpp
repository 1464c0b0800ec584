#include "train/trainer.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include <spdlog/spdlog.h>

#include "cli/progress_bar.hpp"
#include "configs/errors.hpp"
#include "models/altitude_plane.hpp"
#include "models/checkpoint.hpp"
#include "models/depth_conversion.hpp"
#include "train/batch_loader.hpp"

namespace alight {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

DepthCompletionNet make_network(const TrainConfig& config) {
  const auto cores = static_cast<int>(std::thread::hardware_concurrency());
  at::set_num_threads(config.train.threads > 0 ? config.train.threads : std::max(cores, 1));
  torch::manual_seed(static_cast<std::uint64_t>(config.train.seed));
  return DepthCompletionNet(config.model);
}

void add(EpochLosses& sum, const LossTerms& terms) {
  sum.depth += terms.depth.item<double>();
  sum.ratio += terms.ratio.item<double>();
  sum.photometric += terms.photometric.item<double>();
  sum.smoothness += terms.smoothness.item<double>();
  sum.total += terms.total.item<double>();
}

EpochLosses divided(const EpochLosses& sum, double count) {
  return {sum.depth / count, sum.ratio / count, sum.photometric / count, sum.smoothness / count,
          sum.total / count};
}

std::string describe(const EpochLosses& l) {
  char text[128];
  std::snprintf(text, sizeof text, "loss %.4f (depth %.4f ratio %.4f photo %.4f smooth %.4f)", l.total,
                l.depth, l.ratio, l.photometric, l.smoothness);
  return text;
}

}  // namespace

double learning_rate_factor(const TrainingLoopConfig& config, int epoch, std::int64_t step) {
  const double dropped =
      config.drop_after_epoch > 0 && epoch > config.drop_after_epoch ? config.drop_factor : 1.0;
  if (step >= config.warmup_steps) return dropped;
  return dropped * static_cast<double>(step + 1) / static_cast<double>(config.warmup_steps);
}

Trainer::Trainer(const TrainConfig& config, SampleSource& training, SampleSource* validation,
                 RunFolder& folder)
    : config_(config),
      cache_(training, static_cast<std::size_t>(config.train.cache_mb) << 20U),
      validation_(validation),
      folder_(folder),
      net_(make_network(config)) {
  adam_.emplace(net_->parameters(), torch::optim::AdamOptions(config.train.learning_rate));
}

LossTerms Trainer::losses_of(const Batch& batch) {
  const DepthKind kind = config_.model.depth_kind;
  const NetworkInput input =
      sample_density(batch.left, batch.right, batch.sparse_m, batch.offset_s, config_.density,
                     {static_cast<std::uint64_t>(config_.train.seed), step_, 0});
  const torch::Tensor unknown = torch::full_like(batch.height_m, std::numeric_limits<float>::quiet_NaN());
  const torch::Tensor plane_m =
      altitude_planes(torch::where(input.knows_height, batch.height_m, unknown), batch.down_camera,
                      batch.intrinsics_px, batch.left.size(2), batch.left.size(3), config_.model.max_depth_m);
  const SceneView view{input.image, input.right, to_network_depth(plane_m, batch.intrinsics_px, kind),
                       batch.intrinsics_px.select(1, 0) * batch.baseline_m};
  const torch::Tensor depth =
      net_->forward(view, to_network_depth(input.sparse_m, batch.intrinsics_px, kind));
  LossInputs inputs;
  inputs.prediction_m = from_network_depth(depth, batch.intrinsics_px, kind);
  inputs.ground_truth_m = batch.sparse_m;
  inputs.input_m = input.sparse_m;
  inputs.left = batch.left;
  inputs.previous = batch.previous;
  inputs.next = batch.next;
  inputs.right = batch.right;
  inputs.has_previous = batch.has_previous;
  inputs.has_next = batch.has_next;
  inputs.has_right = batch.has_right;
  inputs.T_previous_camera = batch.T_previous_camera;
  inputs.T_next_camera = batch.T_next_camera;
  inputs.baseline_m = batch.baseline_m;
  inputs.intrinsics_px = batch.intrinsics_px;
  return TrainingLoss(config_.loss)(inputs);
}

LossTerms Trainer::train_step(const Batch& batch) {
  LossTerms terms = losses_of(batch);
  if (const std::string term = terms.first_not_finite(); !term.empty()) {
    throw DataError("step " + std::to_string(step_) + ": the " + term +
                    " loss is not finite; lower train.learning_rate, set train.clip_gradient_norm, or use "
                    "loss.depth_error: log. Checkpoints of finished epochs are kept");
  }
  adam_->zero_grad();
  terms.total.backward();
  if (config_.train.clip_gradient_norm > 0) {
    torch::nn::utils::clip_grad_norm_(net_->parameters(), config_.train.clip_gradient_norm);
  }
  adam_->step();
  ++step_;
  return terms;
}

EpochLosses Trainer::train_epoch(int epoch) {
  const TrainingLoopConfig& c = config_.train;
  BatchLoader loader(
      cache_, {c.batch_size, c.steps_per_epoch, c.crop_px, c.workers, static_cast<std::uint64_t>(c.seed)},
      epoch);
  char label[48];
  std::snprintf(label, sizeof label, "epoch %d/%d", epoch, c.epochs);
  ProgressBar bar(label, static_cast<std::int64_t>(loader.batches()) * c.batch_size, "images");
  net_->train();
  EpochLosses sum;
  double steps = 0;
  while (std::optional<Batch> batch = loader.next()) {
    const double rate = c.learning_rate * learning_rate_factor(c, epoch, step_);
    for (auto& group : adam_->param_groups()) group.options().set_lr(rate);
    add(sum, train_step(*batch));
    bar.advance(c.batch_size, describe(divided(sum, ++steps)));
  }
  return divided(sum, steps);
}

std::optional<ValidationReport> Trainer::validate_epoch() {
  if (validation_ == nullptr) return std::nullopt;
  const ValidationConfig& c = config_.validation;
  return validate(net_, *validation_, spread(validation_->size(), c.samples), c.shares,
                  static_cast<std::uint64_t>(config_.train.seed));
}

void Trainer::save(const std::string& name, int epoch) const {
  save_checkpoint(folder_.file(name), net_, {epoch, step_, print_config(config_)}, &*adam_);
}

void Trainer::finish_epoch(int epoch, const EpochLosses& losses, double seconds) {
  const std::optional<ValidationReport> report = validate_epoch();
  save("last.pt", epoch);
  const bool best = !report || !best_score_mm_ || report->score_mm() < *best_score_mm_;
  if (best) save("best.pt", epoch);
  if (report && best) best_score_mm_ = report->score_mm();

  std::vector<std::string> head{"epoch", "steps", "total", "depth", "ratio", "photometric", "smoothness"};
  std::vector<std::string> cells{std::to_string(epoch),    std::to_string(step_), number(losses.total),
                                 number(losses.depth),     number(losses.ratio),  number(losses.photometric),
                                 number(losses.smoothness)};
  std::string summary;
  if (report) {
    for (const ValidationRow& row : report->network) {
      head.push_back("rmse_mm_" + row.name);
      cells.push_back(number(row.ground_truth.rmse_mm()));
      summary += " " + row.name + " " + number(std::round(row.ground_truth.rmse_mm()));
    }
    head.insert(head.end(), {"rmse_mm_altitude_plane"});
    cells.push_back(number(report->altitude_plane.ground_truth.rmse_mm()));
    summary += ", altitude plane " + number(std::round(report->altitude_plane.ground_truth.rmse_mm()));
  }
  head.emplace_back("seconds");
  cells.push_back(number(seconds));
  if (epoch == 1) folder_.append_metrics(head);
  folder_.append_metrics(cells);
  if (report) spdlog::info("epoch {}: validation RMSE [mm]{}{}", epoch, summary, best ? " (best)" : "");
}

void Trainer::run() {
  for (int epoch = 1; epoch <= config_.train.epochs; ++epoch) {
    const auto start = std::chrono::steady_clock::now();
    const EpochLosses losses = train_epoch(epoch);
    finish_epoch(epoch, losses,
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
}

std::optional<ValidationReport> Trainer::evaluate_best() {
  if (validation_ == nullptr) return std::nullopt;
  const LoadedNetwork best = load_network(folder_.file("best.pt"));
  const ValidationConfig& c = config_.validation;
  const std::vector<std::size_t> samples = spread(validation_->size(), c.final_samples);
  ProgressBar bar("validation", static_cast<std::int64_t>(samples.size()), "images");
  ValidationReport report = validate(best.net, *validation_, samples, c.shares,
                                     static_cast<std::uint64_t>(config_.train.seed), [&] { bar.advance(); });
  bar.finish();
  folder_.write("validation.txt", "best.pt, epoch " + std::to_string(best.info.epoch) + ", " +
                                      std::to_string(report.samples) + " samples\n" + report.table());
  return report;
}

}  // namespace alight
