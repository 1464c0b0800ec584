#include "train/train_config.hpp"

#include "foundation/config_reader.hpp"

namespace alight {

void bind(Binder& b, TrainingLoopConfig& c) {
  b.field("epochs", c.epochs, "passes", at_least(1));
  b.field("batch_size", c.batch_size, "samples a batch", at_least(1));
  b.field("steps_per_epoch", c.steps_per_epoch, "batches; 0: as many as the samples give", at_least(0));
  b.field("crop_px", c.crop_px,
          "side of random square cut-outs (the geometry moves along); none: whole images", at_least(32));
  b.field("seed", c.seed, "of weights, order, cut-outs and densities", at_least(0));
  b.field("workers", c.workers, "batches prepared in the background", between(1, 64));
  b.field("cache_mb", c.cache_mb, "memory for decoded samples; 0: read every sample every time", at_least(0));
  b.field("save_every_steps", c.save_every_steps,
          "write last.pt also after so many steps; 0: after epochs only", at_least(0));
  b.field("keep_every_epochs", c.keep_every_epochs,
          "keep a checkpoint of its own every so many epochs; 0: none", at_least(0));
  b.field("early_stop_epochs", c.early_stop_epochs,
          "end after so many epochs without a better validation; 0: never", at_least(0));
  b.field(
      "image_encoder_weights", c.image_encoder_weights,
      "file that the image encoder starts from: of scripts/peers/convert_resnet18.py, or a checkpoint; none: "
      "drawn at random");
}

void bind(Binder& b, TrainConfig& c) {
  b.field("dataset", c.dataset, "folder written by alight-dataset");
  b.section("split", c.split, "what is learned from and what only judges");
  b.section("model", c.model, "network");
  b.section("loss", c.loss, "what is minimised");
  b.section("occlusion_filter", c.occlusion_filter, "which ground truth points are trusted");
  b.section("augmentation", c.augmentation, "other looks of the same samples");
  b.section("density", c.density, "what is fed of the LiDAR points");
  b.section("optimizer", c.optimizer, "how the weights move");
  b.section("schedule", c.schedule, "how the learning rate changes");
  b.section("compute", c.compute, "device and numbers");
  b.section("train", c.train, "loop");
  b.section("validation", c.validation, "after every epoch, on what is held out");
  b.check("augmentation", c.augmentation.quarter_turn_probability <= 0 || c.train.crop_px,
          "quarter turns need square images; set train.crop_px");
  const TrainingLossConfig& l = c.loss;
  b.check("loss", l.depth_weight + l.ratio_weight + l.photometric_weight + l.smoothness_weight > 0,
          "all weights are 0; give one term a weight");
}

}  // namespace alight
