#include "infer/recorder/flight_recorder.hpp"

#include <csignal>

#include <nlohmann/json.hpp>
#include <sys/resource.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "foundation/processes/child_exit.hpp"
#include "tests/infer/recorder/recorded_flight.hpp"
#include "tests/support/programs.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;

class Recorder : public ::testing::Test {
 protected:
  std::vector<Record> of(RecordKind kind) const {
    std::vector<Record> found;
    for (Record& record : read_segments(folder_).records) {
      if (record.kind == kind) found.push_back(std::move(record));
    }
    return found;
  }

  const test::ScratchFolder scratch_;
  const fs::path folder_ = scratch_ / "record";
};

TEST_F(Recorder, KeepsEveryResultAndEveryChangeOfHealth) {
  RecorderConfig config;
  config.max_waiting = 1000;
  fakes::record_flight(folder_, config, 1.5);
  const std::vector<Record> frames = of(RecordKind::kFrame);
  EXPECT_EQ(frames.size(), 49U);  // 20 Hz until 2.45 s
  const auto last = nlohmann::json::parse(frames.back().content);
  EXPECT_EQ(last.at("health").at("state"), "failed");
  EXPECT_EQ(last.at("health").at("findings")[0].at("fault"), "lost");
  const std::vector<Record> changes = of(RecordKind::kHealth);
  ASSERT_EQ(changes.size(), 1U);
  // Silent since 1.5 s; 0.3 s are the limit.
  EXPECT_NEAR(to_seconds(changes.front().t_ns - fakes::kStart_ns), 1.8, 0.03);
}

TEST_F(Recorder, KeepsPicturesNowAndThenAndAtChanges) {
  RecorderConfig config;
  config.max_waiting = 1000;
  config.image_every = 0;
  fakes::record_flight(folder_, config, 1e9);
  // First result, first depth, accepted: the three changes of a quiet flight.
  const std::size_t at_changes = of(RecordKind::kLeft).size();
  EXPECT_GE(at_changes, 2U);
  EXPECT_LE(at_changes, 5U);
  fs::remove_all(folder_);
  config.image_every = 5;
  fakes::record_flight(folder_, config, 1e9);
  EXPECT_GE(of(RecordKind::kLeft).size(), 10U);
  EXPECT_FALSE(of(RecordKind::kDepth).empty());
  EXPECT_FALSE(of(RecordKind::kSafe).empty());
}

TEST_F(Recorder, AFullDiskCostsRecordsAndNoFlight) {
  const pid_t child = test::start_copy([&] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{20000, 20000};
    setrlimit(RLIMIT_FSIZE, &limit);
    RecorderConfig config;
    config.max_waiting = 1000;
    fakes::record_flight(folder_, config, 1e9);
    return 0;
  });
  EXPECT_TRUE(wait_for_child(child).succeeded());
  const SegmentLogContents contents = read_segments(folder_);
  EXPECT_TRUE(contents.damages.empty());
  EXPECT_GT(contents.records.size(), 3U);
}

TEST_F(Recorder, ASlowDiskCostsTheOldestResultsAndIsCounted) {
  RecorderConfig config;
  config.max_waiting = 1;
  FlightRecorder recorder(config, folder_, fakes::small_settings());
  FrameReport frame;
  frame.depth.left = cv::Mat::zeros(144, 160, CV_8UC1);
  const SteadyTime begin = steady_now();
  while (recorder.statistics().lost == 0 && milliseconds(begin, steady_now()) < 60'000) {
    ++frame.depth.t_ns;
    recorder.on_frame(frame);
  }
  EXPECT_GT(recorder.statistics().lost, 0);
}

}  // namespace
}  // namespace alight
