#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/file_text.hpp"
#include "tests/support/programs.hpp"
#include "tests/tools/tool_runner.hpp"

/// alight-train as a user runs it, kills it and goes on with it.
namespace alight::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A network and a run that take seconds.
fs::path small_training(const fs::path& folder, const std::string& more = "") {
  const fs::path path = folder / "train.yaml";
  std::ofstream(path)
      << "dataset: " << quick_dataset().string() << "\n"
      << "model:\n"
         "  image_widths: [4, 4, 8, 8]\n"
         "  depth_widths: [4, 4, 8, 8]\n"
         "  decoder_widths: [8, 4, 4, 4, 4]\n"
         "density: {draw: sample}\n"
         "compute: {threads: 1}\n"
         "train: {epochs: 3, batch_size: 2, steps_per_epoch: 6, crop_px: 64, save_every_steps: 1}\n"
         "validation: {samples: 1, final_samples: 1, shares: [0, 0.3]}\n"
      << more;
  return path;
}

const char* const kHeldOut = "split: {held_out_blocks: [[0.8, 1]], gap_s: 0.1}\n";

std::string command(const fs::path& config, const fs::path& run) {
  return "alight-train --config " + config.string() + " --output " + run.string();
}

TEST(Train, LeavesAllThatARunIsKnownBy) {
  const fs::path folder = test_folder();
  const fs::path run = folder / "run";
  const ToolRun said = run_tool(command(small_training(folder, kHeldOut), run));
  ASSERT_EQ(said.exit_code, 0) << said.out;
  for (const char* name : {"last.pt", "best.pt", "metrics.csv", "validation.txt"})
    EXPECT_TRUE(fs::exists(run / name));
  EXPECT_THAT(file_text(run / "config.yaml"),
              AllOf(HasSubstr("steps_per_epoch: 6"), HasSubstr("window_max_s:")));
  EXPECT_THAT(file_text(run / "provenance.yaml"),
              ::testing::ContainsRegex(
                  "git_revision: (unknown|[0-9a-f]{40}(-dirty)?)\ndataset: .*\ndata_hash: [0-9a-f]{32}\n"));
}

/// Starts the tool and kills it with SIGKILL, as a power cut would, once the run's metrics have so many rows.
/// @returns whether it was still running
bool start_and_kill(const std::string& command_line, const fs::path& run, std::ptrdiff_t rows) {
  Program tool(shell_command("cd " ALIGHT_SOURCE_DIR " && exec " ALIGHT_BINARY_DIR "/bin/" + command_line),
               "/dev/null");
  const auto begin = std::chrono::steady_clock::now();
  const auto metrics_rows = [&] {
    const std::string metrics = file_text(run / "metrics.csv");
    return std::count(metrics.begin(), metrics.end(), '\n');
  };
  while (metrics_rows() < rows && std::chrono::steady_clock::now() - begin < std::chrono::minutes(5))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  tool.send(SIGKILL);
  return tool.wait(60) == 128 + SIGKILL;
}

TEST(Train, RunThatIsKilledAndResumedEqualsTheUninterruptedOne) {
  const fs::path folder = test_folder();
  const fs::path config = small_training(folder, kHeldOut);
  ASSERT_EQ(run_tool(command(config, folder / "whole")).exit_code, 0);
  const fs::path run = folder / "killed";
  const std::string resume = "alight-train --resume " + run.string();
  // Killed after the first and after the second epoch, then left alone. A busy computer may let the tool end before it
  // is killed: then once more.
  constexpr int kHead = 1;
  bool killed = false;
  for (int i = 0; i < 10 && !killed; ++i) {
    fs::remove_all(run);
    killed = start_and_kill(command(config, run), run, kHead + 1) && start_and_kill(resume, run, kHead + 2);
  }
  EXPECT_TRUE(killed) << "the tool had ended before it was killed";
  ASSERT_EQ(run_tool(resume).exit_code, 0);
  EXPECT_EQ(file_text(run / "last.pt"), file_text(folder / "whole" / "last.pt"));
  EXPECT_EQ(file_text(run / "best.pt"), file_text(folder / "whole" / "best.pt"));
}

TEST(Train, EmptySplitSaysWhatToDo) {
  const fs::path folder = test_folder();
  const fs::path config = small_training(folder, "split: {held_out_blocks: [[0, 1]]}\n");
  const ToolRun said = run_tool(command(config, folder / "run"));
  EXPECT_EQ(said.exit_code, 1);
  EXPECT_THAT(said.out, AllOf(HasSubstr("0 samples"), HasSubstr("split")));
}

TEST(Train, SampleWhoseFileIsCutOffIsNamed) {
  const fs::path folder = test_folder();
  const fs::path dataset = folder / "cut";
  fs::copy(quick_dataset(), dataset, fs::copy_options::recursive);
  for (const auto& entry : fs::directory_iterator(dataset / "quick" / "depth")) {
    fs::resize_file(entry.path(), fs::file_size(entry.path()) / 2);
  }
  const ToolRun said =
      run_tool(command(small_training(folder), folder / "run") + " --set dataset=" + dataset.string());
  EXPECT_EQ(said.exit_code, 1);
  EXPECT_THAT(said.out, AllOf(HasSubstr("/depth/0"), HasSubstr(".png")));
}

TEST(Train, ResumeTakesARunAlone) {
  const fs::path folder = test_folder();
  EXPECT_EQ(run_tool("alight-train --resume " + (folder / "absent").string()).exit_code, 1);
  EXPECT_EQ(run_tool("alight-train --resume a --output b").exit_code, 2);
}

}  // namespace
}  // namespace alight::test
