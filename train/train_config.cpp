#include "train/train_config.hpp"

#include <algorithm>

namespace alight {

void bind(Binder& b, TrainingLoopConfig& c) {
  b.field("flights", c.flights, "flights to learn from; []: all that validation does not hold out");
  b.field("epochs", c.epochs, "passes", at_least(1));
  b.field("batch_size", c.batch_size, "samples a step", at_least(1));
  b.field("steps_per_epoch", c.steps_per_epoch, "0: as many as the samples give", at_least(0));
  b.field("crop_px", c.crop_px,
          "side of random square cut-outs (the geometry moves along); none: whole images", at_least(32));
  b.field("learning_rate", c.learning_rate, "of Adam", positive());
  b.field("drop_after_epoch", c.drop_after_epoch, "the learning rate falls after this epoch; 0: never",
          at_least(0));
  b.field("drop_factor", c.drop_factor, "by which it is multiplied then", between(0, 1));
  b.field("warmup_steps", c.warmup_steps, "the learning rate rises linearly over the first steps",
          at_least(0));
  b.field("clip_gradient_norm", c.clip_gradient_norm, "longer gradients are shortened to this; 0: off",
          at_least(0));
  b.field("seed", c.seed, "of weights, order, cut-outs and densities", at_least(0));
  b.field("threads", c.threads, "0: all cores; the same number gives the same weights bit for bit",
          at_least(0));
  b.field("workers", c.workers, "batches prepared in the background", between(1, 64));
  b.field("cache_mb", c.cache_mb, "memory for decoded samples; 0: read every sample every time", at_least(0));
}

void bind(Binder& b, TrainConfig& c) {
  b.field("dataset", c.dataset, "folder written by alight-dataset");
  b.section("model", c.model, "network");
  b.section("loss", c.loss, "what is minimised");
  b.section("density", c.density, "what is fed of the LiDAR points");
  b.section("train", c.train, "loop");
  b.section("validation", c.validation, "evaluation on held-out flights");
  for (const std::string& flight : c.validation.flights) {
    const auto& names = c.train.flights;
    b.check(
        "train", std::find(names.begin(), names.end(), flight) == names.end(),
        "flight " + flight + " is in train.flights and in validation.flights; validation must be held out");
  }
  const TrainingLossConfig& l = c.loss;
  b.check("loss", l.depth_weight + l.ratio_weight + l.photometric_weight + l.smoothness_weight > 0,
          "all weights are 0; give one term a weight");
}

}  // namespace alight
