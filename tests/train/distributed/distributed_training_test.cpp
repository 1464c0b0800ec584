#include <algorithm>
#include <csignal>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "models/checkpoint.hpp"
#include "tests/support/file_text.hpp"
#include "tests/support/programs.hpp"
#include "tests/support/reserved_port.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/train/distributed/tiny_run.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;
using test::Program;
using testing::AllOf;
using testing::HasSubstr;

constexpr int kEpochs = 6;

class DistributedTrainingTest : public testing::Test {
 protected:
  DistributedTrainingTest() { test::write_tiny_dataset(root_ / "data", 10); }

  std::string path(const std::string& name) const { return (root_ / name).string(); }
  std::string read(const std::string& name) const { return test::file_text(root_ / name); }
  /// scripts/cluster/launch.sh. @returns the exit code; what it said is in <root>/log
  int launch(int processes, const std::string& arguments) const {
    return test::run_command("ALIGHT_TRAIN=" ALIGHT_BINARY_DIR "/bin/alight-train " ALIGHT_SOURCE_DIR
                             "/scripts/cluster/launch.sh " +
                             std::to_string(processes) + " " + arguments + " >" + path("log") + " 2>&1")
        .exit_code;
  }
  /// The arguments for a new run. @param name of its folder; its configuration is written beside it
  std::string new_run(const TrainConfig& config, const std::string& name) const {
    std::ofstream(root_ / (name + ".yaml")) << print_config(config);
    return "--config " + path(name + ".yaml") + " --output " + path(name);
  }
  void train(int processes, const TrainConfig& config, const std::string& name) const {
    ASSERT_EQ(launch(processes, new_run(config, name)), 0) << read("log");
  }
  torch::OrderedDict<std::string, torch::Tensor> weights(const std::string& run) const {
    const DepthCompletionNet net = load_network(root_ / run / "last.pt").net;
    auto tensors = net->named_parameters();
    for (const auto& item : net->named_buffers())
      tensors.insert(item.key(), item.value().to(torch::kFloat32));
    return tensors;
  }
  /// Biases begin at zero, where nothing is relative: six steps of 1e-5 move them by far more than 1e-6.
  void expect_close(const std::string& run, const std::string& expected) const {
    const auto wanted = weights(expected);
    for (const auto& item : weights(run)) {
      const torch::Tensor other = wanted[item.key()];
      const double difference = (item.value() - other).norm().item<double>();
      EXPECT_LE(difference, 1e-4 * other.norm().item<double>() + 1e-6) << item.key();
    }
  }
  const test::ScratchFolder root_;
};

TEST_F(DistributedTrainingTest, TwoProcessesLearnWhatOneDoes) {
  for (const DensityDraw draw : {DensityDraw::kBatch, DensityDraw::kSample}) {
    TrainConfig config = test::tiny_run_config(root_ / "data");
    config.density.draw = draw;
    config.optimizer.accumulate = draw == DensityDraw::kBatch ? 1 : 3;
    config.train.steps_per_epoch *= config.optimizer.accumulate;
    const std::string name = draw == DensityDraw::kBatch ? "batch" : "sample";
    train(1, config, name + "1");
    train(2, config, name + "2");
    expect_close(name + "2", name + "1");
    EXPECT_THAT(read("log"), AllOf(HasSubstr("2 processes"), HasSubstr("wrote ")));
    const std::string metrics = read(name + "2/metrics.csv");
    EXPECT_EQ(std::count(metrics.begin(), metrics.end(), '\n'), 3) << "a head and a row an epoch";
  }
}

struct Fault {
  int rank, signal;
};

/// Starts two processes and sends the signal to one of them after the first step. The other has to say so and end.
/// @returns whether that was in mid-run
bool strike(const Fault& fault, const std::string& arguments, const fs::path& run) {
  const test::ReservedPort port;
  Program first(test::rank_command(0, port.number(), arguments), run.string() + ".log0");
  Program second(test::rank_command(1, port.number(), arguments), run.string() + ".log1");
  Program& struck = fault.rank == 0 ? first : second;
  Program& survivor = fault.rank == 0 ? second : first;
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  while (!fs::exists(run / "last.pt") && std::chrono::steady_clock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  struck.send(fault.signal);
  const int exit_code = survivor.wait(120);
  struck.send(SIGKILL);
  if (load_network(run / "last.pt").info.epoch == kEpochs) return false;
  EXPECT_EQ(exit_code, 1) << survivor.said();
  EXPECT_THAT(survivor.said(),
              AllOf(HasSubstr("error: process " + std::to_string(1 - fault.rank) + " of 2: "),
                    HasSubstr("another process is gone or does not answer"), HasSubstr("--resume")));
  return true;
}

/// Whichever process dies or hangs, the other says so and ends, and the run goes on from its last step.
TEST_F(DistributedTrainingTest, RunOutlivesTheDeathOfAnyProcess) {
  TrainConfig config = test::tiny_run_config(root_ / "data");
  config.train.save_every_steps = 1;
  config.train.epochs = kEpochs;
  config.model.stem = Stem::kDownsample;  // faster
  train(2, config, "whole");
  for (const Fault fault : {Fault{1, SIGKILL}, Fault{0, SIGKILL}, Fault{1, SIGSTOP}}) {
    const std::string name = "killed_" + std::to_string(fault.rank) + "_" + std::to_string(fault.signal);
    SCOPED_TRACE(name);
    if (fault.signal == SIGSTOP)
      config.compute.distributed_timeout_s = 10;  // nothing else tells that one hangs
    // A busy computer may let a run end before it is struck: then once more.
    int tries = 0;
    while (!strike(fault, new_run(config, name), root_ / name)) {
      ASSERT_LT(++tries, 10) << "it has to die in mid-run";
      fs::remove_all(root_ / name);
    }
    ASSERT_EQ(launch(2, "--resume " + path(name)), 0) << read("log");
    const auto wanted = weights("whole");
    for (const auto& item : weights(name))
      EXPECT_TRUE(torch::equal(item.value(), wanted[item.key()])) << item.key();
  }
}

TEST_F(DistributedTrainingTest, LauncherEndsAllWithTheCodeOfTheFirstThatFails) {
  TrainConfig config = test::tiny_run_config(root_ / "data");
  config.train.batch_size = 3;
  EXPECT_EQ(launch(2, new_run(config, "odd")), 2);
  EXPECT_THAT(read("log"), HasSubstr("train.batch_size: 3 samples do not divide among 2 processes"));
  EXPECT_THAT(read("log"), HasSubstr("[process 1] error: "));
  fs::create_directories(root_ / "taken" / "something");
  EXPECT_EQ(launch(2, new_run(test::tiny_run_config(root_ / "data"), "taken")), 1);
  EXPECT_THAT(read("log"), HasSubstr("exists already and is not overwritten"));
  EXPECT_EQ(launch(0, ""), 2);
}

}  // namespace
}  // namespace alight
