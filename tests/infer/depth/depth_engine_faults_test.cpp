#include <limits>

#include <gtest/gtest.h>

#include "infer/depth/depth_engine.hpp"
#include "tests/infer/depth/engine_run.hpp"
#include "tests/infer/fakes.hpp"

namespace alight {
namespace {

using engine_run::always;
using engine_run::config_of;
using engine_run::expect_complete;
using engine_run::images_in;
using engine_run::kHeight_m;
using engine_run::Outcome;
using engine_run::run;
using fakes::FakePredictor;
using fakes::FlightPlan;
using fakes::kMillisecond;
using fakes::kStart_ns;
using fakes::LevelWorld;

class DepthEngineFaultModes : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(HistoryAndPaper, DepthEngineFaultModes, testing::Bool());

TEST_P(DepthEngineFaultModes, WithoutLidarStereoAloneDecides) {
  LevelWorld world(kHeight_m);
  FlightPlan plan;
  plan.lidar_begin_s = 1e6;
  const auto messages = fakes::flight(world, plan);
  const Outcome right = run(config_of(GetParam()), messages, always(kHeight_m));
  expect_complete(right, messages);
  for (const DepthResult& result : right.results) {
    EXPECT_EQ(result.source, DepthSource::kImage) << result.reason;
    EXPECT_FALSE(result.stereo.sim_d);
    EXPECT_EQ(result.holdout.points, 0);
  }
  const Outcome wrong = run(config_of(GetParam()), messages, always(1.4 * kHeight_m));
  expect_complete(wrong, messages);
  for (const DepthResult& result : wrong.results) {
    EXPECT_EQ(result.source, DepthSource::kNone);
    EXPECT_TRUE(result.depth_m.empty());
  }
}

TEST_P(DepthEngineFaultModes, WithoutTheRightCameraTheHoldoutDecides) {
  LevelWorld world(kHeight_m);
  FlightPlan plan;
  plan.right = false;
  const auto messages = fakes::flight(world, plan);
  const Outcome right = run(config_of(GetParam()), messages, always(kHeight_m));
  expect_complete(right, messages);
  EXPECT_EQ(right.results[10].source, DepthSource::kImage);
  EXPECT_FALSE(right.results[10].stereo.sim);
  for (const DepthResult& result : run(config_of(GetParam()), messages, always(1.1 * kHeight_m)).results) {
    EXPECT_NE(result.source, DepthSource::kImage);
    EXPECT_NE(result.source, DepthSource::kLidar);
  }
}

TEST_P(DepthEngineFaultModes, WithoutPosesEveryImageSaysSo) {
  LevelWorld world(kHeight_m);
  FlightPlan plan;
  plan.pose_begin_s = 1e6;
  const auto messages = fakes::flight(world, plan);
  const Outcome out = run(config_of(GetParam()), messages, always(kHeight_m));
  expect_complete(out, messages);
  for (const DepthResult& result : out.results) {
    EXPECT_EQ(result.source, DepthSource::kNone);
    EXPECT_EQ(result.reason.rfind("no pose", 0), 0U) << result.reason;
  }
  EXPECT_GT(out.dropped.at("LiDAR points without a pose"), 0);
}

TEST_P(DepthEngineFaultModes, LateMessagesAreWaitedFor) {
  LevelWorld world(kHeight_m);
  FlightPlan plan;
  plan.lidar_delay_s = 0.15;
  const auto messages = fakes::flight(world, plan);
  const Outcome out = run(config_of(GetParam()), messages, always(kHeight_m));
  expect_complete(out, messages);
  EXPECT_EQ(out.results[20].source, DepthSource::kImage);
}

TEST(DepthEngine, PoseGapIsNeverBridged) {
  LevelWorld world(kHeight_m);
  auto messages = fakes::flight(world, {3.0});
  const auto in_gap = [](std::int64_t t_ns) {
    return t_ns > kStart_ns + 1000 * kMillisecond && t_ns < kStart_ns + 1300 * kMillisecond;
  };
  messages.erase(std::remove_if(messages.begin(), messages.end(),
                                [&](const LogMessage& m) {
                                  const auto* attitude = std::get_if<AttitudeSample>(&m);
                                  return attitude != nullptr && in_gap(attitude->t_ns);
                                }),
                 messages.end());
  const Outcome out = run(config_of(false), messages, always(kHeight_m));
  expect_complete(out, messages);
  for (const DepthResult& result : out.results) {
    EXPECT_EQ(result.source == DepthSource::kNone, in_gap(result.t_ns))
        << to_seconds(result.t_ns - kStart_ns);
  }
  EXPECT_GT(out.dropped.at("LiDAR points without a pose"), 2000);
}

TEST(DepthEngine, LidarThatDiesMidFlightLeavesTheFallbackOnlyWhileItIsFresh) {
  LevelWorld world(kHeight_m);
  FlightPlan plan;
  plan.duration_s = 5;
  plan.lidar_end_s = 2.0;
  const auto messages = fakes::flight(world, plan);
  const Outcome out = run(config_of(false), messages, always(1.4 * kHeight_m));
  expect_complete(out, messages);
  for (const DepthResult& result : out.results) {
    const double t_s = to_seconds(result.t_ns - kStart_ns);
    if (t_s > 1.1 && t_s < 2.0) EXPECT_EQ(result.source, DepthSource::kFallback) << t_s << result.reason;
    if (t_s > 3.2) EXPECT_EQ(result.source, DepthSource::kNone) << t_s << result.reason;
  }
}

TEST(DepthEngine, BusyEngineSkipsWithAReason) {
  LevelWorld world(kHeight_m);
  DepthEngineConfig config = config_of(true);
  config.max_open_images = 1;
  const auto messages = fakes::flight(world, {4.0});
  const Outcome out = run(config, messages, always(1.4 * kHeight_m));
  expect_complete(out, messages);
  int worked_on = 0;
  int busy = 0;
  for (const DepthResult& result : out.results) {
    worked_on += result.predictions > 0 ? 1 : 0;
    busy += result.reason.rfind("engine busy", 0) == 0 ? 1 : 0;
  }
  EXPECT_GE(worked_on, 3);
  EXPECT_LE(worked_on, 6) << "one image a second";
  EXPECT_EQ(worked_on + busy, static_cast<int>(out.results.size()));
}

TEST(DepthEngine, ImagesOutOfOrderGetTheirLine) {
  LevelWorld world(kHeight_m);
  DepthEngine engine(config_of(false), fakes::small_rig(), always(kHeight_m));
  engine.add(world.frame(kStart_ns + 100 * kMillisecond));
  engine.add(world.frame(kStart_ns + 100 * kMillisecond));
  engine.add(world.frame(kStart_ns + 50 * kMillisecond));
  engine.finish();
  const auto results = engine.take_results();
  ASSERT_EQ(results.size(), 3U);
  EXPECT_EQ(results[1].reason, "not later than the image before it");
  EXPECT_EQ(results[2].reason, "not later than the image before it");
}

TEST(DepthEngine, PredictionThatIsNotANumberIsUnknownAndNeverTrusted) {
  LevelWorld world(kHeight_m);
  const auto messages = fakes::flight(world, {1.0});
  for (const double depth_m : {std::nan(""), -5.0, 0.0, 1e9, std::numeric_limits<double>::infinity()}) {
    for (const DepthResult& result : run(config_of(false), messages, always(depth_m)).results) {
      EXPECT_NE(result.source, DepthSource::kImage) << depth_m;
      EXPECT_NE(result.source, DepthSource::kLidar) << depth_m;
    }
  }
}

TEST(DepthEngine, RefusesAWrongSetUp) {
  DepthEngineConfig config = config_of(false);
  config.width_px = 1000;
  EXPECT_THROW(DepthEngine(config, fakes::small_rig(), nullptr), ConfigError);
  Rig blind = fakes::small_rig();
  blind.lidar0.reset();
  EXPECT_THROW(DepthEngine(config_of(false), blind, nullptr), ConfigError);
  Rig adrift = fakes::small_rig();
  adrift.cam0.T_camera_imu.reset();
  EXPECT_THROW(DepthEngine(config_of(false), adrift, nullptr), ConfigError);
}

/// After half of the flight its LiDAR turns out to be wrong: nothing older goes into later depth.
TEST(DepthEngine, ForgottenLidarIsNotUsedAnyMore) {
  LevelWorld world(kHeight_m);
  DepthEngine engine(config_of(false), fakes::small_rig(), nullptr);
  const std::int64_t forget_ns = kStart_ns + to_nanoseconds(1.55);
  bool forgotten = false;
  std::vector<DepthResult> results;
  for (const LogMessage& message : fakes::flight(world, {3.5})) {
    const std::int64_t t_ns = std::visit([](const auto& typed) { return typed.t_ns; }, message);
    if (!forgotten && t_ns >= forget_ns) {
      engine.forget_lidar("wrong");
      EXPECT_EQ(engine.points_held(), 0U);
      forgotten = true;
    }
    engine.add(message);
    for (DepthResult& result : engine.take_results()) results.push_back(std::move(result));
  }
  for (const DepthResult& result : results) {
    if (result.t_ns < forget_ns) continue;
    // The next packet ends at 1.6 s, a whole second of new LiDAR at 2.6 s: images wait for it.
    const double since_s = to_seconds(result.t_ns - forget_ns);
    EXPECT_EQ(result.source, DepthSource::kFallback) << since_s << " " << result.reason;
    EXPECT_LE(result.accumulation_s, since_s + 1.05);
  }
  EXPECT_GT(results.size(), 40U);
}

TEST(DepthEngine, AFrameWithoutALeftImageIsWorkedOnByTheLidarAlone) {
  LevelWorld world(kHeight_m);
  std::vector<LogMessage> messages = fakes::flight(world, {2.0});
  for (LogMessage& message : messages) {
    if (auto* frame = std::get_if<StereoFrame>(&message)) frame->left = frame->right = cv::Mat();
  }
  auto net = std::make_shared<FakePredictor>([](int) { return kHeight_m; });
  const Outcome out = run(config_of(false), messages, net);
  EXPECT_EQ(net->encoded, 0);
  EXPECT_EQ(static_cast<std::int64_t>(out.results.size()), images_in(messages));
  EXPECT_EQ(out.results.back().source, DepthSource::kFallback);
  EXPECT_EQ(out.results.back().left.size(), cv::Size(160, 144));
}
}  // namespace
}  // namespace alight
