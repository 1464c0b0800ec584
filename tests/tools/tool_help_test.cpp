#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/tools/tool_runner.hpp"

namespace alight::test {
namespace {

using ::testing::HasSubstr;

class EveryTool : public ::testing::TestWithParam<const char*> {};

TEST_P(EveryTool, HelpShowsExamples) {
  const ToolRun run = run_tool(std::string(GetParam()) + " --help");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("Examples"));
  EXPECT_THAT(run.out, HasSubstr(GetParam()));
}

TEST_P(EveryTool, UnknownFlagIsAUsageError) {
  const ToolRun run = run_tool(std::string(GetParam()) + " --no-such-flag");
  EXPECT_EQ(run.exit_code, 2) << run.out;
  EXPECT_FALSE(run.out.empty());
}

TEST_P(EveryTool, VersionIsPrinted) {
  const ToolRun run = run_tool(std::string(GetParam()) + " --version");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("alight "));
}

INSTANTIATE_TEST_SUITE_P(Tools, EveryTool,
                         ::testing::Values("alight-sim", "alight-sim land", "alight-sim campaign",
                                           "alight-calibrate", "alight-calibrate check",
                                           "alight-calibrate lidar", "alight-calibrate stereo",
                                           "alight-dataset", "alight-dataset align", "alight-train",
                                           "alight-evaluate", "alight-evaluate depth", "alight-evaluate self",
                                           "alight-export", "alight-infer"));

TEST(TrainPlot, HelpShowsAnExample) {
  const ToolRun run = run_tool("alight-train plot --help");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, HasSubstr("alight-train plot runs/demo"));
}

TEST(TrainPlot, UsageErrors) {
  EXPECT_EQ(run_tool("alight-train plot --output a.png").exit_code, 2);
  EXPECT_EQ(run_tool("alight-train plot runs/demo").exit_code, 2);
  EXPECT_EQ(run_tool("alight-train plot runs/demo --output a.jpg").exit_code, 2);
  EXPECT_EQ(run_tool("alight-train plot runs/demo --output a.png --no-such-flag").exit_code, 2);
}

class ShippedConfig : public ::testing::TestWithParam<const char*> {};

TEST_P(ShippedConfig, PrintedConfigIsReadBackEqual) {
  const std::string tool = std::string(GetParam()).substr(0, std::string(GetParam()).find(" --config"));
  const ToolRun first = run_tool(std::string(GetParam()) + " --print-config");
  ASSERT_EQ(first.exit_code, 0) << first.out;
  const auto file = test_folder() / "printed.yaml";
  ASSERT_EQ(run_tool(std::string(GetParam()) + " --print-config > " + file.string()).exit_code, 0);
  const ToolRun second = run_tool(tool + " --config " + file.string() + " --print-config");
  EXPECT_EQ(second.out, first.out);
}

INSTANTIATE_TEST_SUITE_P(Files, ShippedConfig,
                         ::testing::Values("alight-sim --config configs/sim/demo.yaml",
                                           "alight-sim --config configs/sim/quick.yaml",
                                           "alight-dataset build --config configs/dataset/default.yaml",
                                           "alight-train --config configs/train/demo.yaml",
                                           "alight-train --config configs/train/paper.yaml",
                                           "alight-infer --config configs/infer/default.yaml"));

}  // namespace
}  // namespace alight::test
