#include "train/trainer.hpp"

#include <atomic>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "models/checkpoint.hpp"
#include "tests/models/tiny_net.hpp"
#include "tests/support/file_text.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/train/data/memory_source.hpp"

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
  c.compute.threads = 1;
  c.optimizer.learning_rate = 2e-3;
  c.validation.shares = {0, 0.3};
  return c;
}

class TrainerTest : public testing::Test {
 protected:
  std::string bytes(const std::string& name) const { return test::file_text(root_ / name); }
  void train(const TrainConfig& config, const std::string& run) const {
    MemorySource training = scenes(6);
    MemorySource validation = scenes(2, 50);
    RunFolder folder(root_ / run);
    Trainer(config, training, &validation, folder).run();
  }
  const test::ScratchFolder root_;
};

TEST_F(TrainerTest, SameSeedGivesTheSameFileBitForBit) {
  TrainConfig config = tiny_training();
  config.compute.threads = 2;
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
  const auto events = std::count_if(fs::directory_iterator(root_ / "run"), {}, [](const auto& entry) {
    return entry.path().filename().string().rfind("events.out.tfevents.", 0) == 0 &&
           entry.file_size() > 10'000;
  });
  EXPECT_EQ(events, 1);
  std::istringstream metrics(bytes("run/metrics.csv"));
  std::string head, line;
  std::getline(metrics, head);
  EXPECT_EQ(head,
            "epoch,steps,total,depth,ratio,photometric,smoothness,learning_rate,rmse_mm_P=0,rmse_mm_P=0.3,"
            "rmse_mm_altitude_plane,"
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
  config.optimizer.learning_rate = 5e-3;
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
  config.optimizer.clip_gradient_norm = 1;
  config.train.epochs = 1;
  EXPECT_NO_THROW(train(config, "run"));
}

/// Stands for kill -9: whatever is in memory is lost at a sample, what is on disk stays.
class DyingSource : public MemorySource {
 public:
  DyingSource(MemorySource source, int samples_to_live)
      : MemorySource(std::move(source)), left_(samples_to_live) {}
  DepthSample get(std::size_t index) override {
    if (left_-- <= 0) throw DataError("killed");
    return MemorySource::get(index);
  }

 private:
  std::atomic<int> left_;
};

/// Averages, accumulation, steps inside an epoch: everything that a run has to remember.
TrainConfig resumable_training() {
  TrainConfig config = tiny_training();
  config.train.epochs = 3;
  config.train.cache_mb = 0;  // the source is asked for every sample
  config.train.save_every_steps = 1;
  config.optimizer.average_decay = 0.9;
  config.optimizer.accumulate = 2;
  config.schedule.kind = ScheduleKind::kCosine;
  config.train.batch_size = 1;
  config.density.draw = DensityDraw::kSample;
  return config;
}

TEST_F(TrainerTest, ResumedRunEqualsTheUninterruptedOneBitForBit) {
  const TrainConfig config = resumable_training();
  train(config, "whole");
  const auto seconds_off = [](const std::string& metrics) {
    return std::regex_replace(metrics, std::regex(",[^,\n]*\n"), "\n");
  };
  for (const int killed_after : {0, 1, 5, 7, 12, 17}) {
    const std::string run = "killed_" + std::to_string(killed_after);
    {
      DyingSource training(scenes(6), killed_after);
      MemorySource validation = scenes(2, 50);
      RunFolder folder(root_ / run);
      folder.write("config.yaml", print_config(config));
      EXPECT_THROW(Trainer(config, training, &validation, folder).run(), DataError);
    }
    MemorySource training = scenes(6);
    MemorySource validation = scenes(2, 50);
    RunFolder folder(root_ / run, RunFolder::Open::kExisting);
    Trainer trainer(config, training, &validation, folder);
    trainer.resume();
    trainer.run();
    EXPECT_EQ(bytes(run + "/last.pt"), bytes("whole/last.pt")) << killed_after;
    EXPECT_EQ(bytes(run + "/best.pt"), bytes("whole/best.pt")) << killed_after;
    EXPECT_EQ(seconds_off(bytes(run + "/metrics.csv")), seconds_off(bytes("whole/metrics.csv")))
        << killed_after;
  }
}

TEST_F(TrainerTest, AccumulatedBatchesAreOneLargeBatch) {
  TrainConfig config = tiny_training();
  config.density.draw = DensityDraw::kSample;
  config.train.epochs = 1;
  config.train.batch_size = 4;
  config.train.steps_per_epoch = 1;
  train(config, "large");
  config.train.batch_size = 2;
  config.train.steps_per_epoch = 2;
  config.optimizer.accumulate = 2;
  train(config, "accumulated");
  const auto large = load_network(root_ / "large" / "last.pt").net->named_parameters();
  for (const auto& item : load_network(root_ / "accumulated" / "last.pt").net->named_parameters()) {
    EXPECT_TRUE(torch::allclose(item.value(), large[item.key()], 1e-3, 1e-5)) << item.key();
  }
}

TEST_F(TrainerTest, LowPrecisionAndChannelsLastTrainToo) {
  TrainConfig config = tiny_training();
  config.model.normalization = Normalization::kBatch;
  config.compute.precision = Precision::kBfloat16;
  config.compute.memory_format = MemoryFormat::kChannelsLast;
  train(config, "run");
  for (const auto& item : load_network(root_ / "run" / "last.pt").net->named_parameters()) {
    EXPECT_EQ(item.value().scalar_type(), torch::kFloat32) << item.key();
    EXPECT_TRUE(item.value().isfinite().all().item<bool>()) << item.key();
  }
}

TEST_F(TrainerTest, StartsFromAnotherNetworksImageEncoder) {
  TrainConfig config = tiny_training();
  train(config, "first");
  config.train.seed = 5;
  config.train.image_encoder_weights = (root_ / "first" / "last.pt").string();
  MemorySource training = scenes(6);
  RunFolder folder(root_ / "second");
  const DepthCompletionNet net = Trainer(config, training, nullptr, folder).net();
  const auto first = load_network(root_ / "first" / "last.pt").net->named_parameters();
  for (const auto& item : net->named_parameters()) {
    const bool image = item.key().rfind("image_encoder.", 0) == 0 && item.value().dim() == 4;
    const bool depth = item.key().rfind("depth_encoder.", 0) == 0 && item.value().dim() == 4;
    if (image) {
      EXPECT_TRUE(torch::equal(item.value(), first[item.key()])) << item.key();
    }
    if (depth) {
      EXPECT_FALSE(torch::equal(item.value(), first[item.key()])) << item.key();
    }
  }
}

TEST_F(TrainerTest, KeepsEveryNthEpochAndStopsEarly) {
  TrainConfig config = tiny_training();
  config.train.epochs = 30;
  config.train.keep_every_epochs = 2;
  config.train.early_stop_epochs = 2;
  config.optimizer.learning_rate = 1e-12;  // nothing gets better after the first epoch
  train(config, "run");
  const LoadedNetwork last = load_network(root_ / "run" / "last.pt");
  EXPECT_EQ(last.info.epoch, last.info.best_epoch + 2);
  EXPECT_TRUE(fs::exists(root_ / "run" / "epoch_0002.pt"));
  EXPECT_FALSE(fs::exists(root_ / "run" / "epoch_0001.pt"));
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
    EXPECT_THAT(e.what(), testing::ContainsRegex("step 0, samples [01], [01]: the depth loss is not finite"));
  }
}

}  // namespace
}  // namespace alight
