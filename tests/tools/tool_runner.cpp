#include "tests/tools/tool_runner.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/support/scratch_folder.hpp"

namespace alight::test {
namespace fs = std::filesystem;

ToolRun run_tool(const std::string& command_line) {
  return run_command("cd " ALIGHT_SOURCE_DIR " && " ALIGHT_BINARY_DIR "/bin/" + command_line);
}

namespace {

/// Of this process; removed at its end.
const fs::path& process_folder() {
  static const ScratchFolder folder;
  return folder.path();
}

}  // namespace

fs::path test_folder() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  fs::path folder = process_folder() / (std::string(info->test_suite_name()) + "." + info->name());
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

const fs::path& quick_flight() {
  static const fs::path folder = [] {
    const fs::path path = process_folder() / "quick_flight";
    const ToolRun run = run_tool("alight-sim --config configs/sim/quick.yaml --output " + path.string());
    if (run.exit_code != 0) throw std::runtime_error("alight-sim failed: " + run.out);
    return path;
  }();
  return folder;
}

const fs::path& quick_dataset() {
  static const fs::path folder = [] {
    const fs::path path = process_folder() / "quick_dataset";
    const ToolRun run = run_tool("alight-dataset build --config configs/dataset/default.yaml --log " +
                                 (quick_flight() / "quick.bag").string() + " --output " + path.string());
    if (run.exit_code != 0) throw std::runtime_error("alight-dataset failed: " + run.out);
    return path;
  }();
  return folder;
}

}  // namespace alight::test
