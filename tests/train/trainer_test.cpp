#include "train/trainer.hpp"

#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configs/errors.hpp"
#include "models/checkpoint.hpp"
#include "tests/models/tiny_net.hpp"
#include "tests/train/memory_source.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using test::MemorySource;
using test::scenes;

TrainConfig tiny_training() {
  TrainConfig c;
  c.model = test::tiny_config();
  c.model.normalization = Normalization::kGroup;
  c.train.epochs = 2;
  c.train.batch_size = 2;
  c.train.crop_px = 32;
  c.train.threads = 1;
  c.train.learning_rate = 2e-3;
  c.validation.shares = {0, 0.3};
  return c;
}

class TrainerTest : public testing::Test {
 protected:
  void SetUp() override { fs::remove_all(root_); }
  void TearDown() override { fs::remove_all(root_); }
  std::string bytes(const std::string& name) const {
    std::ifstream stream(root_ / name, std::ios::binary);
    std::stringstream content;
    content << stream.rdbuf();
    return content.str();
  }
  void train(const TrainConfig& config, const std::string& run) const {
    MemorySource training = scenes(6);
    MemorySource validation = scenes(2, 50);
    RunFolder folder(root_ / run);
    Trainer(config, training, &validation, folder).run();
  }
  const fs::path root_ = fs::temp_directory_path() / "alight_trainer";
};

TEST_F(TrainerTest, SameSeedGivesTheSameFileBitForBit) {
  TrainConfig config = tiny_training();
  config.train.threads = 2;
  train(config, "a");
  config.train.workers = 3;
  train(config, "b");
  const auto weights = [&](const std::string& run) { return load_network(root_ / run / "last.pt").net; };
  const DepthCompletionNet a = weights("a");
  const auto b = weights("b")->named_parameters();
  for (const auto& item : a->named_parameters())
    EXPECT_TRUE(torch::equal(item.value(), b[item.key()])) << item.key();

  config.train.workers = 1;
  train(config, "c");
  EXPECT_EQ(bytes("a/last.pt"), bytes("c/last.pt"));

  config.train.seed = 2;
  train(config, "d");
  EXPECT_FALSE(torch::equal(weights("d")->parameters()[0], a->parameters()[0]));
}

TEST_F(TrainerTest, RunFolderHoldsCheckpointsAndMetrics) {
  train(tiny_training(), "run");
  const LoadedNetwork last = load_network(root_ / "run" / "last.pt");
  EXPECT_EQ(last.info.epoch, 2);
  EXPECT_EQ(last.info.step, 6);
  EXPECT_THAT(last.info.train_config, testing::HasSubstr("batch_size: 2"));
  EXPECT_TRUE(fs::exists(root_ / "run" / "best.pt"));
  std::istringstream metrics(bytes("run/metrics.csv"));
  std::string head, line;
  std::getline(metrics, head);
  EXPECT_EQ(
      head,
      "epoch,steps,total,depth,ratio,photometric,smoothness,rmse_mm_P=0,rmse_mm_P=0.3,rmse_mm_altitude_plane,"
      "seconds");
  int lines = 0;
  while (std::getline(metrics, line)) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), std::count(head.begin(), head.end(), ','));
    ++lines;
  }
  EXPECT_EQ(lines, 2);
}

TEST_F(TrainerTest, LearnsToBeatTheAltitudePlane) {
  TrainConfig config = tiny_training();
  config.loss.depth_error = DepthError::kLog;
  config.loss.smoothness_weight = 0;
  config.density.draw = DensityDraw::kSample;
  config.train.epochs = 3;
  config.train.steps_per_epoch = 20;
  config.train.learning_rate = 5e-3;
  MemorySource training = scenes(12);
  MemorySource validation = scenes(4, 50);
  RunFolder folder(root_ / "run");
  Trainer trainer(config, training, &validation, folder);
  trainer.run();
  const std::optional<ValidationReport> report = trainer.evaluate_best();
  ASSERT_TRUE(report);
  EXPECT_LT(report->at(0.3).ground_truth.rmse_mm(), report->altitude_plane.ground_truth.rmse_mm());
  EXPECT_THAT(bytes("run/validation.txt"), testing::HasSubstr("altitude plane"));
}

TEST_F(TrainerTest, PerspectiveNetworksAndWholeImagesTrainToo) {
  TrainConfig config = tiny_training();
  config.model.depth_kind = DepthKind::kPerspective;
  config.model.depth_input = DepthInput::kRaw;
  config.model.head = Head::kDirect;
  config.train.crop_px.reset();
  config.train.clip_gradient_norm = 1;
  config.train.epochs = 1;
  EXPECT_NO_THROW(train(config, "run"));
}

TEST_F(TrainerTest, LossThatIsNotFiniteNamesStepAndTerm) {
  std::vector<DepthSample> samples;
  for (std::int64_t i = 0; i < 2; ++i) {
    samples.push_back(test::scene_sample(i));
    samples.back().sparse.fill_(std::numeric_limits<float>::max());  // its square overflows
  }
  MemorySource training(samples);
  RunFolder folder(root_ / "run");
  Trainer trainer(tiny_training(), training, nullptr, folder);
  try {
    trainer.run();
    FAIL() << "expected a DataError";
  } catch (const DataError& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("step 0: the depth loss is not finite"));
  }
}

TEST(LearningRate, FallsAfterTheEpochAndRisesAtFirst) {
  TrainingLoopConfig c;
  EXPECT_EQ(learning_rate_factor(c, 20, 1000), 1);
  EXPECT_EQ(learning_rate_factor(c, 21, 1000), 0.1);
  c.warmup_steps = 10;
  EXPECT_EQ(learning_rate_factor(c, 1, 0), 0.1);
  EXPECT_EQ(learning_rate_factor(c, 1, 9), 1);
  c.drop_after_epoch = 0;
  EXPECT_EQ(learning_rate_factor(c, 99, 1000), 1);
}

}  // namespace
}  // namespace alight
