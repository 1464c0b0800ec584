#include "tool_runner.hpp"

#include <array>
#include <cstdio>
#include <stdexcept>

#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

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

fs::path test_folder() {
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  fs::path folder =
      fs::path(::testing::TempDir()) / ("alight_tools_" + std::to_string(getpid())) / info->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

const fs::path& quick_flight() {
  static const fs::path folder = [] {
    const fs::path path =
        fs::path(::testing::TempDir()) / ("alight_tools_" + std::to_string(getpid())) / "quick_flight";
    fs::remove_all(path);
    const ToolRun run = run_tool("alight-sim --config configs/sim/quick.yaml --output " + path.string());
    if (run.exit_code != 0) throw std::runtime_error("alight-sim failed: " + run.out);
    return path;
  }();
  return folder;
}

const fs::path& quick_dataset() {
  static const fs::path folder = [] {
    const fs::path path = quick_flight().parent_path() / "quick_dataset";
    fs::remove_all(path);
    const ToolRun run = run_tool("alight-dataset build --config configs/dataset/default.yaml --log " +
                                 (quick_flight() / "quick.bag").string() + " --output " + path.string());
    if (run.exit_code != 0) throw std::runtime_error("alight-dataset failed: " + run.out);
    return path;
  }();
  return folder;
}

}  // namespace alight::test
