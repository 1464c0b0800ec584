#include "train/trainer.hpp"

#include <cmath>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "foundation/progress_bar.hpp"
#include "foundation/shipped_files.hpp"
#include "train/distributed/sync_batch_norm.hpp"
#include "train/network_pass.hpp"

namespace alight {
namespace {

constexpr std::size_t kTerms = 5;
constexpr char kProvenanceFile[] = "provenance.yaml";

std::string number(double value) { return fmt::format("{:.6g}", value); }

DepthCompletionNet make_network(const TrainConfig& config, torch::Device device, const ProcessGroup& group) {
  set_threads(config.compute.threads, group.place().local_size);
  // Numbers of 1e-39 say nothing and cost a hundred times what others do.
  at::globalContext().setFlushDenormal(true);
  torch::manual_seed(static_cast<std::uint64_t>(config.train.seed));
  DepthCompletionNet net(config.model);
  if (group.size() > 1) {
    synchronize_batch_norms(*net, [group](torch::Tensor& sum) { group.all_reduce_sum({sum}); });
  }
  place(*net, device, config.compute.memory_format);
  // Another processor may draw the same seed's weights a little differently.
  group.broadcast(net->parameters());
  return net;
}

std::vector<torch::Tensor> gradients(const torch::nn::Module& module) {
  std::vector<torch::Tensor> gradients;
  for (const torch::Tensor& parameter : module.parameters()) gradients.push_back(parameter.grad());
  return gradients;
}

void check_batch(int batch_size, int processes) {
  if (batch_size % processes == 0) return;
  throw ConfigError("train.batch_size: " + std::to_string(batch_size) + " samples do not divide among " +
                    std::to_string(processes) + " processes; it is the size for all of them together");
}

std::vector<double> values(const LossTerms& terms) {
  return {terms.depth.item<double>(), terms.ratio.item<double>(), terms.photometric.item<double>(),
          terms.smoothness.item<double>(), terms.total.item<double>()};
}

std::string describe(const std::vector<double>& l) {
  return fmt::format("loss {:.4f} (depth {:.4f} ratio {:.4f} photo {:.4f} smooth {:.4f})", l[4], l[0], l[1],
                     l[2], l[3]);
}

std::string epoch_file(int epoch) { return fmt::format("epoch_{:04}.pt", epoch); }

}  // namespace

Trainer::Trainer(const TrainConfig& config, SampleSource& training, SampleSource* validation,
                 RunFolder& folder, ProcessGroup group)
    : config_(config),
      group_(std::move(group)),
      device_(find_device(config.compute.device, group_.place().local_rank)),
      cache_(training, static_cast<std::size_t>(config.train.cache_mb) << 20U),
      validation_(validation),
      folder_(folder),
      net_(make_network(config, device_, group_)),
      flying_(net_) {
  check_batch(config_.train.batch_size, group_.size());
  group_.expect_same("the number of training samples", static_cast<std::int64_t>(training.size()));
  if (config_.train.image_encoder_weights)
    load_image_encoder(input_file(*config_.train.image_encoder_weights), net_);
  if (config_.optimizer.average_decay > 0) {
    flying_ = DepthCompletionNet(config_.model);
    place(*flying_, device_, MemoryFormat::kContiguous);
    update_average(*flying_, *net_, 0, 0);
    flying_->eval();
  }
  optimizer_.emplace(*net_, config_.optimizer);
  progress_.train_config = print_config(config_);
  progress_.epoch_losses.assign(kTerms, 0);
}

void Trainer::resume() {
  if (folder_.has("last.pt")) {
    progress_ = load_training(folder_.file("last.pt"), flying_, {net_, &optimizer_->adam()});
    spdlog::info("goes on after epoch {}, step {}", progress_.epoch, progress_.step);
  } else {
    spdlog::info("{}: no last.pt yet, the run starts anew", folder_.path().string());
  }
  group_.expect_same("the step to go on from", progress_.step);
  if (writes()) folder_.keep_metrics(progress_.epoch);
}

BatchLoader Trainer::loader(int epoch, std::size_t first_batch) {
  const TrainingLoopConfig& c = config_.train;
  return {cache_,
          {c.batch_size, c.steps_per_epoch, c.crop_px, c.workers, static_cast<std::uint64_t>(c.seed),
           config_.augmentation, group_.rank(), group_.size()},
          epoch,
          first_batch};
}

std::int64_t Trainer::steps_per_epoch() {
  return static_cast<std::int64_t>(loader(1, 0).batches()) / config_.optimizer.accumulate;
}

/// @param place among all of the step's samples of the batch's first, of whichever process
LossTerms Trainer::losses_of(const Batch& batch, std::int64_t place) {
  place += group_.rank() * static_cast<std::int64_t>(batch.indices.size());
  const NetworkInput input =
      sample_density(batch.left, batch.right, batch.sparse_m, batch.offset_s, config_.density,
                     {static_cast<std::uint64_t>(config_.train.seed), progress_.step, place});
  torch::Tensor prediction_m;
  {
    const PrecisionScope scope(config_.compute.precision, device_);
    prediction_m = predict(net_, batch, input);
  }
  const torch::Tensor ground_truth_m =
      drop_hidden_points(batch.sparse_m, batch.offset_s, config_.occlusion_filter);
  return TrainingLoss(config_.loss)(loss_inputs(batch, input, prediction_m, ground_truth_m));
}

void Trainer::check_finite(const LossTerms& terms, const Batch& batch) const {
  const std::string term = terms.first_not_finite();
  if (term.empty()) return;
  std::string samples;
  for (const std::int64_t index : batch.indices)
    samples += (samples.empty() ? "" : ", ") + std::to_string(index);
  throw DataError(
      "step " + std::to_string(progress_.step) + ", samples " + samples + ": the " + term +
      " loss is not finite; lower optimizer.learning_rate, set optimizer.clip_gradient_norm, or use "
      "loss.depth_error: log. Checkpoints of finished epochs are kept");
}

void Trainer::train_step(const std::function<Batch()>& next_batch, int epoch, std::int64_t steps_an_epoch) {
  optimizer_->zero_grad();
  const int count = config_.optimizer.accumulate;
  for (int i = 0; i < count; ++i) {
    const Batch batch = next_batch().to(device_, torch_format(config_.compute.memory_format));
    const LossTerms terms = losses_of(batch, static_cast<std::int64_t>(i) * config_.train.batch_size);
    check_finite(terms, batch);
    (terms.total / count).backward();
    const std::vector<double> losses = group_.mean(values(terms));
    for (std::size_t k = 0; k < kTerms; ++k) progress_.epoch_losses[k] += losses[k] / count;
  }
  group_.all_reduce_mean(gradients(*net_));
  const std::int64_t total_steps = config_.train.epochs * steps_an_epoch;
  learning_rate_ = config_.optimizer.learning_rate *
                   learning_rate_factor(config_.schedule, epoch, progress_.step, total_steps);
  optimizer_->step(learning_rate_);
  if (flying_.ptr() != net_.ptr()) {
    update_average(*flying_, *net_, config_.optimizer.average_decay, progress_.step);
  }
  ++progress_.step;
}

std::vector<double> Trainer::mean_losses() const {
  const double steps = static_cast<double>(progress_.epoch_step);
  Losses means = progress_.epoch_losses;
  for (double& mean : means) mean /= std::max(steps, 1.0);
  return means;
}

void Trainer::train_epoch(int epoch) {
  const TrainingLoopConfig& c = config_.train;
  const std::int64_t steps = steps_per_epoch();
  const std::int64_t images_a_step = static_cast<std::int64_t>(c.batch_size) * config_.optimizer.accumulate;
  BatchLoader batches =
      loader(epoch, static_cast<std::size_t>(progress_.epoch_step * config_.optimizer.accumulate));
  const std::string label = fmt::format("epoch {}/{}", epoch, c.epochs);
  std::optional<ProgressBar> bar;
  if (writes()) bar.emplace(label, (steps - progress_.epoch_step) * images_a_step, "images");
  net_->train();
  while (progress_.epoch_step < steps) {
    train_step([&] { return *batches.next(); }, epoch, steps);
    ++progress_.epoch_step;
    if (bar) bar->advance(images_a_step, describe(mean_losses()));
    if (c.save_every_steps > 0 && progress_.step % c.save_every_steps == 0) save("last.pt");
  }
}

/// Rank 0's report; empty on the others.
std::optional<ValidationReport> Trainer::validate_epoch() {
  std::optional<ValidationReport> report;
  if (validation_ == nullptr) return report;
  group_.on_first_rank([&](const std::function<void()>& alive) {
    report = validate(flying_, *validation_, spread(validation_->size(), config_.validation.samples),
                      config_.validation, static_cast<std::uint64_t>(config_.train.seed), alive);
  });
  return report;
}

void Trainer::save(const std::string& name) {
  if (!writes()) return;
  save_checkpoint(folder_.file(name), flying_, progress_, {net_, &optimizer_->adam()});
}

void Trainer::finish_epoch(int epoch, double seconds) {
  const std::optional<ValidationReport> report = validate_epoch();
  // metrics.csv before last.pt: a run that is killed in between writes the row once more, and never loses it.
  if (writes()) write_metrics(epoch, report, seconds);
  const double score = group_.of_first_rank(report ? report->score_mm() : progress_.best_score);
  const bool best = validation_ == nullptr || score < progress_.best_score;
  if (best) {
    progress_.best_epoch = epoch;
    progress_.best_score = score;
  }
  progress_.epoch = epoch;
  progress_.epoch_step = 0;
  progress_.epoch_losses.assign(kTerms, 0);
  if (best) save("best.pt");
  if (config_.train.keep_every_epochs > 0 && epoch % config_.train.keep_every_epochs == 0)
    save(epoch_file(epoch));
  save("last.pt");
  if (report)
    spdlog::info("epoch {}: validation RMSE [mm]{}{}", epoch, report->summary(), best ? " (best)" : "");
}

void Trainer::write_metrics(int epoch, const std::optional<ValidationReport>& report, double seconds) {
  std::vector<std::string> names{"total", "depth", "ratio", "photometric", "smoothness", "learning_rate"};
  const Losses losses = mean_losses();
  std::vector<double> numbers{losses[4], losses[0], losses[1], losses[2], losses[3], learning_rate_};
  if (report) {
    for (const ValidationRow& row : report->network) {
      names.push_back("rmse_mm_" + row.name);
      numbers.push_back(row.ground_truth.rmse_mm());
    }
    names.emplace_back("rmse_mm_altitude_plane");
    numbers.push_back(report->altitude_plane.ground_truth.rmse_mm());
  }
  names.emplace_back("seconds");
  numbers.push_back(seconds);
  std::vector<std::string> head{"epoch", "steps"};
  head.insert(head.end(), names.begin(), names.end());
  std::vector<std::string> cells{std::to_string(epoch), std::to_string(progress_.step)};
  for (const double value : numbers) cells.push_back(number(value));
  if (epoch == 1) folder_.append_metrics(head);
  folder_.append_metrics(cells);
  write_events(names, numbers);
}

void Trainer::write_events(const std::vector<std::string>& names, const std::vector<double>& values) {
  std::vector<std::pair<std::string, double>> scalars;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool error = names[i].rfind("rmse_mm_", 0) == 0;
    scalars.emplace_back((error ? "validation/" : "training/") + names[i], values[i]);
  }
  events_->scalars(progress_.step, scalars);
  events_->weights(progress_.step, net_);
  if (validation_ != nullptr) events_->panel(progress_.step, flying_, validation_->get(0));
  events_->flush();
}

void Trainer::open_events() {
  const bool resumed = progress_.step > 0;
  events_.emplace(folder_.path(), resumed ? std::optional(progress_.step) : std::nullopt);
  events_->describe(progress_.step, progress_.train_config,
                    folder_.has(kProvenanceFile) ? folder_.read(kProvenanceFile) : std::string());
}

void Trainer::run() {
  const TrainingLoopConfig& c = config_.train;
  if (writes()) open_events();
  for (auto epoch = static_cast<int>(progress_.epoch) + 1; epoch <= c.epochs; ++epoch) {
    if (c.early_stop_epochs > 0 && progress_.epoch - progress_.best_epoch >= c.early_stop_epochs) {
      spdlog::info("no better validation for {} epochs: the run ends early", c.early_stop_epochs);
      return;
    }
    const auto start = std::chrono::steady_clock::now();
    train_epoch(epoch);
    finish_epoch(epoch, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
}

std::optional<ValidationReport> Trainer::evaluate_best() {
  if (validation_ == nullptr || !writes()) return std::nullopt;
  const LoadedNetwork best = load_network(folder_.file("best.pt"), device_);
  const std::vector<std::size_t> samples = spread(validation_->size(), config_.validation.final_samples);
  ProgressBar bar("validation", static_cast<std::int64_t>(samples.size()), "images");
  ValidationReport report = validate(best.net, *validation_, samples, config_.validation,
                                     static_cast<std::uint64_t>(config_.train.seed), [&] { bar.advance(); });
  bar.finish();
  folder_.write("validation.txt", "best.pt, epoch " + std::to_string(best.info.epoch) + ", " +
                                      std::to_string(report.samples) + " samples\n" + report.table());
  return report;
}

}  // namespace alight
