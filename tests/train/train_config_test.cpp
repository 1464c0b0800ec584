#include "train/train_config.hpp"

#include <filesystem>

#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;

TEST(TrainConfig, EveryShippedFileLoads) {
  int files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(ALIGHT_SOURCE_DIR) / "configs" / "train")) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_NO_THROW(load_config<TrainConfig>(entry.path())) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 2);
}

TEST(TrainConfig, WeightsToStartFromAreAKey) {
  const auto c = parse_config<TrainConfig>("train: {image_encoder_weights: resnet18.pt}", "test.yaml");
  EXPECT_EQ(c.train.image_encoder_weights, "resnet18.pt");
  EXPECT_EQ(parse_config<TrainConfig>("", "test.yaml").train.image_encoder_weights, std::nullopt);
}

TEST(TrainConfig, PaperFileIsThePapersConfiguration) {
  const auto c = load_config<TrainConfig>(fs::path(ALIGHT_SOURCE_DIR) / "configs" / "train" / "paper.yaml");
  EXPECT_EQ(c.loss.depth_weight, 1);
  EXPECT_EQ(c.loss.ratio_weight, 1);
  EXPECT_EQ(c.loss.photometric_weight, 2);
  EXPECT_EQ(c.loss.smoothness_weight, 1);
  EXPECT_EQ(c.loss.depth_error, DepthError::kSquared);
  EXPECT_FALSE(c.loss.smoothness.edge_aware);
  EXPECT_EQ(c.density.mode, DensityMode::kShare);
  EXPECT_EQ(c.density.draw, DensityDraw::kBatch);
  EXPECT_EQ(c.density.no_lidar_probability, 0.2);
  EXPECT_EQ(c.optimizer.learning_rate, 2e-4);
  EXPECT_EQ(c.optimizer.kind, OptimizerKind::kAdam);
  EXPECT_EQ(c.schedule.kind, ScheduleKind::kStep);
  EXPECT_EQ(c.train.batch_size, 16);
  EXPECT_EQ(c.train.epochs, 30);
  EXPECT_EQ(c.schedule.drop_after_epoch, 20);
  EXPECT_EQ(c.schedule.drop_factor, 0.1);
  EXPECT_EQ(c.model.depth_input, DepthInput::kRaw);
  EXPECT_EQ(c.model.head, Head::kDirect);
  EXPECT_EQ(c.model.depth_kind, DepthKind::kPerspective);
}

TEST(TrainConfig, SomethingMustBeMinimised) {
  EXPECT_THROW(
      parse_config<TrainConfig>(
          "loss: {depth_weight: 0, ratio_weight: 0, photometric_weight: 0, smoothness_weight: 0}", "test"),
      ConfigError);
}

TEST(TrainConfig, PrintsAndReadsBack) {
  TrainConfig c;
  c.train.crop_px = 192;
  c.split.unknown_flights = {"flight_3"};
  c.split.held_out_blocks = {{0.2, 0.4}};
  const std::string text = print_config(c);
  EXPECT_EQ(print_config(parse_config<TrainConfig>(text, "printed")), text);
}

}  // namespace
}  // namespace alight
