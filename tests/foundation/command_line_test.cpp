#include "foundation/command_line.hpp"

#include <stdexcept>

#include <gtest/gtest.h>

namespace alight {
namespace {

int run(std::vector<std::string> arguments, const std::function<int()>& body) {
  CLI::App app("a tool", "tool");
  bool flag = false;
  app.add_flag("--flag", flag);
  arguments.insert(arguments.begin(), "tool");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  return run_tool(app, static_cast<int>(argv.size()), argv.data(), body);
}

TEST(RunTool, ExitCodesTellUsageFromFailure) {
  EXPECT_EQ(run({"--flag"}, [] { return 0; }), kExitOk);
  EXPECT_EQ(run({"--help"}, [] { return 7; }), kExitOk);
  EXPECT_EQ(run({"--version"}, [] { return 7; }), kExitOk);
  EXPECT_EQ(run({"--flog"}, [] { return 0; }), kExitUsage);
  EXPECT_EQ(run({}, []() -> int { throw ConfigError("c"); }), kExitUsage);
  EXPECT_EQ(run({}, []() -> int { throw DataError("d"); }), kExitFailure);
  EXPECT_EQ(run({}, []() -> int { throw std::runtime_error("r"); }), kExitFailure);
}

}  // namespace
}  // namespace alight
