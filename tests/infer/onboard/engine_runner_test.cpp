#include "infer/onboard/engine_runner.hpp"

#include <stdexcept>
#include <thread>

#include <opencv2/core/utility.hpp>

#include <gtest/gtest.h>

#include "infer/replay/result_writer.hpp"
#include "tests/infer/fakes.hpp"

namespace alight {
namespace {

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
/// OpenCV's own threads hand over their work by means that ThreadSanitizer does not see.
const bool kOneThread = (cv::setNumThreads(0), true);
#endif
#endif

constexpr double kHeight_m = 12.0;

DepthEngineConfig engine_config() {
  DepthEngineConfig config;
  config.width_px = 160;
  config.height_px = 144;
  return config;
}

std::unique_ptr<LandingPipeline> pipeline(const Rig& rig) {
  return std::make_unique<LandingPipeline>(
      engine_config(), LandingConfig{}, rig,
      std::make_shared<fakes::FakePredictor>([](int) { return kHeight_m; }));
}

class Lines : public FrameSink {
 public:
  void on_message(const LogMessage& message) override {
    static_cast<void>(message);
    ++messages;
  }
  void on_frame(const FrameReport& frame) override { lines.push_back(to_json_line(frame, {}, false)); }
  std::vector<std::string> lines;
  int messages = 0;
};

const MessageQueueConfig kRoomForAll{10000, 10000, 100000};

TEST(EngineRunner, GivesWhatThePipelineGives) {
  const Rig rig = fakes::small_rig();
  fakes::LevelWorld world(kHeight_m);
  const auto messages = fakes::flight(world, {2.0});
  std::vector<std::string> expected;
  const auto direct = pipeline(rig);
  const auto note = [&](const std::vector<FrameReport>& frames) {
    for (const FrameReport& frame : frames) expected.push_back(to_json_line(frame, {}, false));
  };
  for (const LogMessage& message : messages) note(direct->add(message));
  note(direct->finish());

  Lines lines;
  EngineRunner runner(kRoomForAll, pipeline(rig), {&lines});
  for (const LogMessage& message : messages) runner.push(message);
  runner.finish();
  EXPECT_EQ(lines.lines, expected);
  EXPECT_EQ(lines.messages, static_cast<int>(messages.size()));
  const RunnerStatistics statistics = runner.statistics();
  EXPECT_EQ(statistics.images, static_cast<std::int64_t>(expected.size()));
  EXPECT_EQ(statistics.queued, 0U);
  EXPECT_GT(statistics.max_latency_ms, 0);
  EXPECT_LE(statistics.latency_ms(0.5), statistics.latency_ms(0.95));
  EXPECT_LE(statistics.latency_ms(0.95), statistics.max_latency_ms);
}

TEST(EngineRunner, WhatASinkThrowsArrivesAtFinish) {
  class Full : public FrameSink {
    void on_frame(const FrameReport&) override { throw std::runtime_error("the disk is full"); }
  } full;
  fakes::LevelWorld world(kHeight_m);
  EngineRunner runner(kRoomForAll, pipeline(fakes::small_rig()), {&full});
  for (const LogMessage& message : fakes::flight(world, {2.0})) runner.push(message);
  EXPECT_THROW(runner.finish(), std::runtime_error);
  EXPECT_TRUE(runner.failed());
}

TEST(EngineRunner, IsAbandonedAtOnce) {
  fakes::LevelWorld world(kHeight_m);
  Lines lines;
  {
    EngineRunner runner(kRoomForAll, pipeline(fakes::small_rig()), {&lines});
    for (const LogMessage& message : fakes::flight(world, {2.0})) runner.push(message);
  }
  SUCCEED() << "no hang, no crash";
}

/// Statistics are asked for from elsewhere while the engine works, which ThreadSanitizer watches.
TEST(EngineRunner, StatisticsMayBeAskedForAtAnyTime) {
  fakes::LevelWorld world(kHeight_m);
  Lines lines;
  EngineRunner runner({1, 2, 10}, pipeline(fakes::small_rig()), {&lines});
  std::atomic<bool> done{false};
  std::thread asking([&] {
    while (!done) static_cast<void>(runner.statistics());
  });
  std::int64_t images = 0;
  for (const LogMessage& message : fakes::flight(world, {2.0})) {
    images += std::holds_alternative<StereoFrame>(message) ? 1 : 0;
    runner.push(message);
  }
  runner.finish();
  done = true;
  asking.join();
  std::int64_t lost = 0;
  for (const auto& [reason, count] : runner.statistics().dropped)
    lost += reason.rfind("image pushed", 0) == 0 ? count : 0;
  // At least: while no image comes through, LiDAR packets make results of their own.
  EXPECT_GE(runner.statistics().images + lost, images) << "every image has a result or is counted";
}

}  // namespace
}  // namespace alight
