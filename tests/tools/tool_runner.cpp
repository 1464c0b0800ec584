#include "tests/tools/tool_runner.hpp"

#include <array>
#include <cstdio>
#include <stdexcept>

#include <sys/wait.h>

#include <gtest/gtest.h>

#include "tests/support/scratch_folder.hpp"

namespace alight::test {
namespace fs = std::filesystem;

ToolRun run_tool(const std::string& command_line) {
  const std::string command =
      "cd " ALIGHT_SOURCE_DIR " && " ALIGHT_BINARY_DIR "/bin/" + command_line + " 2>&1 < /dev/null";
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("popen failed");
  ToolRun run;
  std::array<char, 4096> buffer{};
  while (const std::size_t n = fread(buffer.data(), 1, buffer.size(), pipe)) run.out.append(buffer.data(), n);
  const int status = pclose(pipe);
  run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return run;
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
