#include <fstream>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/Float32.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "models/checkpoint.hpp"
#include "tests/support/file_text.hpp"
#include "tests/tools/tool_runner.hpp"

/// Bad input, one test a fault: the message names file and cause, the exit code tells usage (2) from failure (1), and
/// nothing half-written stays behind.
namespace alight::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

void write_file(const fs::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

/// Both tools that read logs, writing to `out` in the test's folder.
std::vector<std::string> log_readers(const fs::path& log, const fs::path& out) {
  return {"alight-dataset build --config configs/dataset/default.yaml --log " + log.string() + " --output " +
              out.string(),
          "alight-infer --config configs/infer/default.yaml --checkpoint " +
              (out.parent_path() / "net.pt").string() + " --log " + log.string() + " --output " +
              out.string()};
}

void expect_refused(const std::string& command, int exit_code, const std::vector<std::string>& words,
                    const fs::path& out) {
  const ToolRun run = run_tool(command);
  EXPECT_EQ(run.exit_code, exit_code) << command << "\n" << run.out;
  for (const std::string& word : words) EXPECT_THAT(run.out, HasSubstr(word)) << command;
  EXPECT_FALSE(fs::exists(out)) << command;
  EXPECT_FALSE(fs::exists(out.string() + ".partial")) << command;
}

DepthCompletionConfig small_network() {
  DepthCompletionConfig config;
  config.image_widths = {8, 8, 16, 16};
  config.depth_widths = {8, 8, 8, 8};
  config.decoder_widths = {16, 8, 8, 8, 8};
  return config;
}

class LogFaults : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = test_folder();
    save_checkpoint(folder_ / "net.pt", DepthCompletionNet(small_network()));
  }
  void expect_log_refused(const fs::path& log, const std::vector<std::string>& words) const {
    for (const std::string& command : log_readers(log, folder_ / "out")) {
      expect_refused(command, 1, words, folder_ / "out");
    }
  }
  /// The quick flight's bag with one topic left out, or written as another type.
  fs::path filtered_bag(const std::string& topic, bool as_float) const {
    const fs::path path = folder_ / "filtered.bag";
    rosbag::Bag in((quick_flight() / "quick.bag").string(), rosbag::bagmode::Read);
    rosbag::Bag out(path.string(), rosbag::bagmode::Write);
    for (const rosbag::MessageInstance& message : rosbag::View(in)) {
      if (message.getTopic() != topic) {
        out.write(message.getTopic(), message.getTime(), message);
      } else if (as_float) {
        out.write(topic, message.getTime(), std_msgs::Float32());
      }
    }
    out.close();
    return path;
  }
  fs::path folder_;
};

TEST_F(LogFaults, MissingFile) { expect_log_refused(folder_ / "nowhere.bag", {"nowhere.bag"}); }

TEST_F(LogFaults, EmptyFile) {
  write_file(folder_ / "empty.bag", "");
  expect_log_refused(folder_ / "empty.bag", {"empty.bag"});
}

TEST_F(LogFaults, TextInPlaceOfABag) {
  write_file(folder_ / "text.bag", "this is no bag\n");
  expect_log_refused(folder_ / "text.bag", {"text.bag"});
}

TEST_F(LogFaults, BagWithoutMessages) {
  {
    rosbag::Bag bag((folder_ / "hollow.bag").string(), rosbag::bagmode::Write);
  }
  expect_log_refused(folder_ / "hollow.bag", {"hollow.bag"});
}

TEST_F(LogFaults, TruncatedBag) {
  const std::string whole = file_text(quick_flight() / "quick.bag");
  write_file(folder_ / "cut.bag", whole.substr(0, whole.size() * 2 / 3));
  expect_log_refused(folder_ / "cut.bag", {"cut.bag"});
}

TEST_F(LogFaults, BagWithoutANeededTopic) {
  expect_log_refused(filtered_bag("/livox/lidar", false), {"filtered.bag", "/livox/lidar"});
}

TEST_F(LogFaults, WrongMessageType) {
  expect_log_refused(filtered_bag("/dji_sdk/attitude", true),
                     {"filtered.bag", "/dji_sdk/attitude", "std_msgs/Float32"});
}

TEST_F(LogFaults, OutputFolderThatExistsIsNotTouched) {
  const fs::path out = folder_ / "mine";
  fs::create_directories(out);
  write_file(out / "precious", "x");
  for (const std::string& command : log_readers(quick_flight() / "quick.bag", out)) {
    const ToolRun run = run_tool(command);
    EXPECT_EQ(run.exit_code, 1) << command << "\n" << run.out;
    EXPECT_THAT(run.out, HasSubstr("exists already"));
  }
  EXPECT_EQ(file_text(out / "precious"), "x");
  EXPECT_EQ(std::distance(fs::directory_iterator(out), {}), 1);
}

TEST_F(LogFaults, RigWithANonRotationMatrix) {
  std::string rig = file_text(std::string(ALIGHT_SOURCE_DIR) + "/configs/rigs/paper.yaml");
  const std::string row = "- [0, -1, 0, 0.04]";
  rig.replace(rig.find(row), row.size(), "- [0, -2, 0, 0.04]");
  write_file(folder_ / "bad_rig.yaml", rig);
  for (const std::string& command : log_readers(quick_flight() / "quick.bag", folder_ / "out")) {
    expect_refused(command + " --set rig=" + (folder_ / "bad_rig.yaml").string(), 2,
                   {"bad_rig.yaml:12", "T_cam_imu", "no rigid transform"}, folder_ / "out");
  }
}

TEST(ConfigFaults, MisspeltKeyNamesFileLineAndTheKeyMeant) {
  const fs::path folder = test_folder();
  const struct {
    const char* tool;
    const char* arguments;
  } tools[] = {{"alight-sim", ""},
               {"alight-dataset build", "--log a.bag"},
               {"alight-train", ""},
               {"alight-evaluate", "--data data/demo"},
               {"alight-infer", "--log a.bag"}};
  for (const auto& [tool, arguments] : tools) {
    const fs::path config = folder / "config.yaml";
    write_file(config, "no_such_key_at_all: 1\n");
    expect_refused(std::string(tool) + " --config " + config.string() + " " + arguments + " --output " +
                       (folder / "out").string(),
                   2, {"config.yaml:1", "no_such_key_at_all", "no such key"}, folder / "out");
    expect_refused(std::string(tool) + " --config " + (folder / "nowhere.yaml").string() + " " + arguments +
                       " --output " + (folder / "out").string(),
                   2, {"nowhere.yaml"}, folder / "out");
  }
}

TEST_F(LogFaults, CheckpointThatIsNone) {
  write_file(folder_ / "net.pt", "no network");
  expect_refused(log_readers(quick_flight() / "quick.bag", folder_ / "out")[1], 1, {"net.pt"},
                 folder_ / "out");
  fs::remove(folder_ / "net.pt");
  expect_refused(log_readers(quick_flight() / "quick.bag", folder_ / "out")[1], 1, {"net.pt"},
                 folder_ / "out");
}

TEST(TrainPlotFaults, DamagedMetricsNameFileAndLine) {
  const fs::path folder = test_folder();
  write_file(folder / "metrics.csv", "epoch,total\n1,0.5\n2,0.\x01\n");
  const fs::path png = folder / "curves.png";
  expect_refused("alight-train plot " + folder.string() + " --output " + png.string(), 1,
                 {"metrics.csv:3", "total", "a number"}, png);
}

class ExportTool : public LogFaults {};

TEST_F(ExportTool, RefusesWhatIsNoNetworkAndUnknownFormats) {
  const std::string command = "alight-export --checkpoint " + (folder_ / "net.pt").string() + " --output ";
  expect_refused(command + (folder_ / "net.tflite").string(), 2, {"net.tflite", ".onnx", ".torchscript"},
                 folder_ / "net.tflite");
  expect_refused(command + (folder_ / "absent" / "net.onnx").string(), 1, {"net.onnx", "cannot be written"},
                 folder_ / "absent");
  expect_refused(command + (folder_ / "net.onnx").string() + " --graph half", 2, {"half"},
                 folder_ / "net.onnx");
  write_file(folder_ / "net.pt", "no network");
  expect_refused(command + (folder_ / "net.onnx").string(), 1, {"net.pt"}, folder_ / "net.onnx");
}

TEST_F(ExportTool, WritesTheWholeAndItsHalvesAndSaysSo) {
  const ToolRun run = run_tool("alight-export --checkpoint " + (folder_ / "net.pt").string() + " --output " +
                               (folder_ / "net.onnx").string() + " --size 75 45");
  EXPECT_EQ(run.exit_code, 0) << run.out;
  for (const char* name : {"net.onnx", "net.image_encoder.onnx", "net.refinement.onnx"}) {
    EXPECT_TRUE(fs::exists(folder_ / name)) << name;
    EXPECT_THAT(run.out, HasSubstr(std::string(name) + " (75 x 45 px)"));
  }
}

/// A file whose weights are another network's than its stated architecture.
TEST_F(LogFaults, CheckpointOfAnotherNetwork) {
  DepthCompletionConfig wider = small_network();
  wider.decoder_widths = {32, 8, 8, 8, 8};
  torch::serialize::InputArchive saved;
  saved.load_from((folder_ / "net.pt").string());
  torch::serialize::OutputArchive archive;
  for (const std::string& key : saved.keys()) {
    c10::IValue value;
    saved.read(key, value);
    archive.write(key, key == "model_config" ? c10::IValue(print_config(wider)) : value);
  }
  archive.save_to((folder_ / "net.pt").string());
  expect_refused(log_readers(quick_flight() / "quick.bag", folder_ / "out")[1], 1,
                 {"net.pt", "another network", "decoder1"}, folder_ / "out");
}

}  // namespace
}  // namespace alight::test
