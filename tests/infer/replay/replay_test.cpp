#include "infer/replay/replay.hpp"

#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "infer/replay/overlay.hpp"
#include "infer/replay/stage_benchmark.hpp"
#include "tests/infer/bag_of_flight.hpp"
#include "tests/infer/fakes.hpp"
#include "tests/support/file_text.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {
namespace fs = std::filesystem;

constexpr double kFlown_m = 12.0;

ReplayConfig small_replay() {
  ReplayConfig config;
  config.write_timings = false;
  config.engine.width_px = 160;
  config.engine.height_px = 144;
  config.log.height_topic.reset();
  return config;
}

std::shared_ptr<DepthPredictor> right_predictor() {
  return std::make_shared<fakes::FakePredictor>([](int) { return kFlown_m; });
}

class Replay : public testing::Test {
 protected:
  void SetUp() override {
    fakes::LevelWorld world(kFlown_m);
    const auto messages = fakes::flight(world, {2.0});
    fakes::write_bag((folder_ / "flight.bag").string(), rig_, messages);
  }

  Rig rig_ = fakes::small_rig();
  const test::ScratchFolder scratch_;
  const fs::path folder_ = scratch_.path();
};

TEST_F(Replay, WritesOneLineAnImagePicturesAndTheConfiguration) {
  const ReplaySummary summary =
      replay(small_replay(), rig_, folder_ / "flight.bag", folder_ / "out", right_predictor());
  std::istringstream lines(test::file_text(folder_ / "out" / "results.jsonl"));
  std::int64_t count = 0;
  std::int64_t accepted = 0;
  for (std::string line; std::getline(lines, line);) {
    const nlohmann::json json = nlohmann::json::parse(line);
    ++count;
    EXPECT_EQ(json.at("crop").at("width"), 160);
    EXPECT_EQ(json.at("crop").at("x"), 8);
    EXPECT_EQ(json.at("source"), "image");
    EXPECT_EQ(json.at("accumulation_s"), 0);
    EXPECT_GT(json.at("sim_pred").get<double>(), json.at("sim").get<double>());
    EXPECT_LT(json.at("holdout_error_m").get<double>(), 0.1);
    EXPECT_FALSE(json.contains("stages_ms"));
    ASSERT_FALSE(json.at("site").is_null());
    EXPECT_GT(json.at("site").at("radius_m"), 2);
    EXPECT_EQ(json.at("site").at("p_world").size(), 3U);
    accepted += json.at("site").at("accepted").get<bool>() ? 1 : 0;
  }
  EXPECT_EQ(count, summary.images);
  EXPECT_EQ(count, 39);
  EXPECT_EQ(accepted, count - 4);
  EXPECT_EQ(summary.accepted, accepted);
  EXPECT_FALSE(fs::is_empty(folder_ / "out" / "overlay"));
  EXPECT_EQ(cv::imread((folder_ / "out" / "method.png").string()).cols, 4 * 160 + 3 * 4);
  EXPECT_EQ(print_config(load_config<ReplayConfig>(folder_ / "out" / "config.yaml")),
            print_config(small_replay()));
  EXPECT_NE(summary.page().find("source image"), std::string::npos);
}

TEST_F(Replay, WritesEverySoManyDepthMaps) {
  ReplayConfig config = small_replay();
  config.depth_every = 10;
  const ReplaySummary summary =
      replay(config, rig_, folder_ / "flight.bag", folder_ / "out", right_predictor());
  EXPECT_EQ(summary.images, 39);
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder_ / "out" / "depth")) {
    ++files;
    const cv::Mat depth_m = cv::imread(entry.path().string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(depth_m.type(), CV_32FC1) << entry.path();
    ASSERT_EQ(depth_m.size(), cv::Size(160, 144)) << entry.path();
    EXPECT_EQ(cv::countNonZero(depth_m != static_cast<float>(kFlown_m)), 0) << entry.path();
  }
  EXPECT_EQ(files, 4);
}

TEST_F(Replay, TwiceIsTheSameByteForByte) {
  for (const char* name : {"a", "b"}) {
    replay(small_replay(), rig_, folder_ / "flight.bag", folder_ / name, right_predictor());
  }
  EXPECT_EQ(test::file_text(folder_ / "a" / "results.jsonl"),
            test::file_text(folder_ / "b" / "results.jsonl"));
  EXPECT_EQ(test::file_text(folder_ / "a" / "method.png"), test::file_text(folder_ / "b" / "method.png"));
}

TEST_F(Replay, RefusesAFolderThatExistsAndLeavesNothingBehindOnFailure) {
  fs::create_directories(folder_ / "mine");
  std::ofstream(folder_ / "mine" / "precious") << "x";
  EXPECT_THROW(replay(small_replay(), rig_, folder_ / "flight.bag", folder_ / "mine", right_predictor()),
               DataError);
  EXPECT_THROW(replay(small_replay(), rig_, folder_ / "none.bag", folder_ / "out", right_predictor()),
               DataError);
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  EXPECT_FALSE(fs::exists(folder_ / "out.partial"));
}

TEST_F(Replay, WithoutAnOutputFolderNothingIsWritten) {
  const auto before = std::distance(fs::directory_iterator(folder_), {});
  EXPECT_EQ(replay(small_replay(), rig_, folder_ / "flight.bag", "", right_predictor()).images, 39);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), before);
}

TEST(ShippedFiles, AllLoad) {
  const fs::path configs = fs::path(ALIGHT_SOURCE_DIR) / "configs";
  int files = 0;
  for (const auto& entry : fs::directory_iterator(configs / "infer")) {
    EXPECT_NO_THROW(load_config<ReplayConfig>(entry.path())) << entry.path();
    ++files;
  }
  for (const auto& entry : fs::directory_iterator(configs / "landing")) {
    EXPECT_NO_THROW(load_config<LandingConfig>(entry.path())) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 5);
  EXPECT_EQ(print_config(load_config<ReplayConfig>(configs / "infer" / "default.yaml")),
            print_config(ReplayConfig{}));
  EXPECT_EQ(print_config(load_config<LandingConfig>(configs / "landing" / "default.yaml")),
            print_config(LandingConfig{}));
}

TEST(Overlay, FramesWithoutDepthAreDrawnToo) {
  FrameReport frame;
  frame.depth.left = cv::Mat(40, 60, CV_8UC1, cv::Scalar(90));
  frame.depth.sparse_m = cv::Mat::zeros(40, 60, CV_32FC1);
  EXPECT_EQ(replay_strip(frame).size(), cv::Size(4 * 60 + 12, 64));
  EXPECT_EQ(method_strip(frame).size(), cv::Size(4 * 60 + 12, 64));
}

TEST(StageStatistics, MedianAndPercentile) {
  StageStatistics statistics;
  for (int i = 1; i <= 100; ++i) statistics.add({{"site", i}});
  EXPECT_NE(statistics.table().find("51.00"), std::string::npos) << statistics.table();
  EXPECT_NE(statistics.table().find("95.00"), std::string::npos) << statistics.table();
}

TEST(SyntheticHover, TheLoopUnderstandsIt) {
  DepthEngineConfig config;
  config.width_px = 160;
  config.height_px = 144;
  Rig rig = fakes::small_rig();
  DepthEngine engine(config, rig, std::make_shared<fakes::FakePredictor>([](int) { return 9.0; }));
  for (const LogMessage& message : synthetic_hover(rig, 9, 1.5)) engine.add(message);
  engine.finish();
  const auto results = engine.take_results();
  ASSERT_EQ(results.size(), 30U);
  EXPECT_EQ(results[20].source, DepthSource::kImage) << results[20].reason;
}

}  // namespace
}  // namespace alight
