#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "models/checkpoint.hpp"
#include "tests/support/file_text.hpp"
#include "tests/tools/tool_runner.hpp"

/// alight-evaluate on a short simulated flight, as a user runs it.
namespace alight::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string on_quick(const std::string& arguments) {
  return "alight-evaluate --data " + quick_dataset().string() + " " + arguments;
}

TEST(Evaluate, WritesATableAndPicturesOfANetworkBesideTheBaselines) {
  const fs::path folder = test_folder();
  DepthCompletionConfig config;
  config.image_widths = {8, 8, 16, 16};
  config.depth_widths = {8, 8, 8, 8};
  config.decoder_widths = {16, 8, 8, 8, 8};
  save_checkpoint(folder / "net.pt", DepthCompletionNet(config));
  const ToolRun run = run_tool(on_quick("--checkpoint " + (folder / "net.pt").string() + " --output " +
                                        (folder / "table.md").string() + " --every 5 --pictures " +
                                        (folder / "worst").string() + " --picture-count 1"));
  ASSERT_EQ(run.exit_code, 0) << run.out;
  const std::string table = file_text(folder / "table.md");
  for (const char* method :
       {"net.pt", "nearest", "Delaunay", "Delaunay, inverse depth", "IP-Basic", "altitude plane"}) {
    EXPECT_THAT(table, HasSubstr(std::string(method) + " | ")) << method;
  }
  for (const char* region :
       {"all", "held_out", "dense", "inside_fov", "outside_fov", "near_edges", "right image"}) {
    EXPECT_THAT(table, HasSubstr("\n## " + std::string(region) + "\n")) << region;
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "worst"), {}), 1);
}

TEST(Evaluate, MistakesAreNamedBeforeTheWorkBegins) {
  const fs::path folder = test_folder();
  const std::string out = " --output " + (folder / "t.csv").string();
  const auto expect = [](const std::string& command, int exit_code, const std::string& words) {
    const ToolRun run = run_tool(command);
    EXPECT_EQ(run.exit_code, exit_code) << command << "\n" << run.out;
    EXPECT_THAT(run.out, HasSubstr(words)) << command;
  };
  expect(on_quick("--output " + (folder / "table.txt").string()), 2, ".md, .csv or .json");
  expect(on_quick("--output /no/such/folder/t.md"), 1, "/no/such/folder");
  expect("alight-evaluate" + out, 2, "--data is missing");
  expect(on_quick(""), 2, "--output is missing");
  expect("alight-evaluate --data /no/such/set" + out, 1, "/no/such/set");
  expect(on_quick("--blocks 0.6:0.4" + out), 2, "0.6:0.4");
  expect(on_quick("--blocks 0.4" + out), 2, "begin:end");
  expect(on_quick("--flights quik" + out), 2, "no flight \"quik\"; the data set has quick");
  expect(on_quick("--checkpoint /no/net.pt" + out), 1, "/no/net.pt");
  expect(on_quick("--part unknown" + out), 2, "no sample is left");
  const fs::path train = folder / "train.yaml";
  std::ofstream(train) << "split: {unknown_flights: [quik]}\n";
  expect(on_quick("--part unknown --split " + train.string() + out), 2, "no flight \"quik\"");
}

/// An untrained network is nowhere good, so there is a document but no curve to draw.
TEST(EvaluateSelf, WritesADocumentAndScores) {
  const fs::path folder = test_folder();
  save_checkpoint(folder / "net.pt", DepthCompletionNet(DepthCompletionConfig()));
  const ToolRun run =
      run_tool("alight-evaluate self --data " + quick_dataset().string() + " --checkpoint " +
               (folder / "net.pt").string() + " --windows 0,0.1 --every 20 --output " +
               (folder / "self.md").string() + " --scores " + (folder / "scores.csv").string());
  ASSERT_EQ(run.exit_code, 0) << run.out;
  EXPECT_THAT(file_text(folder / "self.md"),
              AllOf(HasSubstr("--windows 0,0.1"), HasSubstr("| wrong_height |"),
                    HasSubstr("| hold-out median |"), HasSubstr("| both |")));
  EXPECT_THAT(file_text(folder / "scores.csv"), HasSubstr("\nquick,0,0.1,delaunay,"));
}

TEST(EvaluateSelf, MistakesAreNamedBeforeTheWorkBegins) {
  const std::string out = " --output " + (test_folder() / "t.md").string();
  const auto expect = [](const std::string& arguments, int exit_code, const std::string& words) {
    const ToolRun run = run_tool("alight-evaluate self " + arguments);
    EXPECT_EQ(run.exit_code, exit_code) << arguments << "\n" << run.out;
    EXPECT_THAT(run.out, HasSubstr(words)) << arguments;
  };
  const std::string data = " --data " + quick_dataset().string();
  expect(data + out, 2, "--checkpoint is missing");
  expect("--checkpoint net.pt" + out, 2, "--data is missing");
  expect("--checkpoint net.pt" + data, 2, "--output is missing");
  expect("--checkpoint net.pt --output t.txt" + data, 2, ".md");
  expect("--checkpoint net.pt --figure f.jpg" + data + out, 2, ".png");
  expect("--checkpoint net.pt --scores /no/such/folder/s.csv" + data + out, 1, "/no/such/folder");
  expect("--checkpoint net.pt --good 0.95:0.1" + data + out, 2, "0.95:0.1");
  expect("--checkpoint net.pt --good 1.5:0.1:0.01" + data + out, 2, "1.5:0.1:0.01");
  expect("--checkpoint net.pt --part unknown" + data + out, 2, "--split");
  expect("--checkpoint net.pt --flights quik" + data + out, 2, "no flight \"quik\"");
  expect("--checkpoint /no/net.pt" + data + out, 1, "/no/net.pt");
}

TEST(EvaluateDepth, JudgesADepthMapOfADataSet) {
  const fs::path flight = quick_dataset() / "quick";
  const std::string pair = "alight-evaluate depth --rig configs/rigs/paper.yaml --left " +
                           (flight / "left/000000.png").string() + " --right " +
                           (flight / "right/000000.png").string() + " --depth " +
                           (flight / "dense/000000.png").string();
  const ToolRun run =
      run_tool(pair + " --centre-cropped --sparse " + (flight / "depth/000000.png").string() + " --truth " +
               (flight / "dense/000000.png").string() + " --config configs/infer/paper.yaml");
  EXPECT_EQ(run.exit_code, 0) << run.out;
  EXPECT_THAT(run.out, AllOf(HasSubstr("sim_pred   0."), HasSubstr("sim_d      0."), HasSubstr("verdict"),
                             HasSubstr("RMSE [mm]          0.00")));
  const ToolRun uncropped = run_tool(pair);
  EXPECT_EQ(uncropped.exit_code, 1);
  EXPECT_THAT(uncropped.out, HasSubstr("--centre-cropped"));
}

}  // namespace
}  // namespace alight::test
