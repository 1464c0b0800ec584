#include "infer/depth_engine.hpp"

#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "tests/infer/fakes.hpp"

namespace alight {
namespace {

using fakes::FakePredictor;
using fakes::FlightPlan;
using fakes::kMillisecond;
using fakes::kStart_ns;
using fakes::LevelWorld;

constexpr double kHeight_m = 6.0;

/// Engine for the fakes' small images; `paper`: LiDAR after the image, a prediction per packet.
DepthEngineConfig config_of(bool paper) {
  DepthEngineConfig config;
  config.image.warm_images = 0;  // every image for itself, unless a test says otherwise
  config.width_px = 160;
  config.height_px = 144;
  if (paper) {
    config.history_s = 0;
    config.image.step_growth = 1;
  }
  return config;
}

struct Outcome {
  std::vector<DepthResult> results;
  std::map<std::string, std::int64_t> dropped;
};

Outcome run(const DepthEngineConfig& config, const std::vector<LogMessage>& messages,
            std::shared_ptr<DepthPredictor> net) {
  DepthEngine engine(config, fakes::small_rig(), std::move(net));
  Outcome out;
  const auto take = [&] {
    for (DepthResult& result : engine.take_results()) out.results.push_back(std::move(result));
  };
  for (const LogMessage& message : messages) {
    engine.add(message);
    take();
  }
  engine.finish();
  take();
  out.dropped = engine.dropped();
  return out;
}

std::int64_t images_in(const std::vector<LogMessage>& messages) {
  return std::count_if(messages.begin(), messages.end(),
                       [](const LogMessage& m) { return std::holds_alternative<StereoFrame>(m); });
}

/// Every image once, in order, with what its source promises.
void expect_complete(const Outcome& run, const std::vector<LogMessage>& messages) {
  EXPECT_EQ(static_cast<std::int64_t>(run.results.size()), images_in(messages));
  for (std::size_t i = 0; i < run.results.size(); ++i) {
    const DepthResult& result = run.results[i];
    if (i > 0) EXPECT_GT(result.t_ns, run.results[i - 1].t_ns);
    EXPECT_FALSE(result.reason.empty());
    EXPECT_EQ(result.depth_m.empty(), result.source == DepthSource::kNone);
    if (result.source == DepthSource::kImage) EXPECT_EQ(result.accumulation_s, 0);
    if (result.source == DepthSource::kLidar) EXPECT_GT(result.accumulation_s, 0);
    if (result.depth_m.empty()) continue;
    EXPECT_TRUE(result.T_world_camera);
    EXPECT_EQ(cv::countNonZero((result.depth_m > 0) != (result.pixel_source > 0)), 0);
  }
}

std::shared_ptr<FakePredictor> always(double depth_m) {
  return std::make_shared<FakePredictor>([depth_m](int) { return depth_m; });
}

class DepthEngineModes : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(HistoryAndPaper, DepthEngineModes, testing::Bool());

TEST_P(DepthEngineModes, RightPredictionIsTrustedFromTheImageAlone) {
  LevelWorld world(kHeight_m);
  const auto messages = fakes::flight(world, {});
  const auto net = always(kHeight_m);
  const Outcome out = run(config_of(GetParam()), messages, net);
  expect_complete(out, messages);
  for (const DepthResult& result : out.results) {
    const bool judged = result.t_ns < kStart_ns + 1900 * kMillisecond;  // a packet came after it
    if (!judged && GetParam()) continue;
    EXPECT_EQ(result.source, DepthSource::kImage) << result.reason;
    EXPECT_EQ(result.predictions, 1);
    EXPECT_GT(result.holdout.points, 100);
    EXPECT_LT(result.holdout.rms_m, 0.02);
    EXPECT_GT(*result.stereo.sim_pred, *result.stereo.sim + 0.2);
    EXPECT_EQ(result.pixel_source.at<std::uint8_t>(72, 80), static_cast<int>(PixelSource::kPredicted));
    EXPECT_EQ(result.pixel_source.at<std::uint8_t>(2, 2),
              static_cast<int>(PixelSource::kPredictedOutsideFov));
  }
  EXPECT_EQ(net->encoded, static_cast<int>(out.results.size()));
}

TEST_P(DepthEngineModes, WrongPredictionIsRefinedUntilItIsRight) {
  LevelWorld world(kHeight_m);
  const auto messages = fakes::flight(world, {3.0});
  // Right once it has seen more than three packets (each brings fewer than 2000 new pixels).
  const auto net =
      std::make_shared<FakePredictor>([](int points) { return points > 5500 ? kHeight_m : 1.4 * kHeight_m; });
  const Outcome out = run(config_of(GetParam()), messages, net);
  expect_complete(out, messages);
  int refined = 0;
  for (const DepthResult& result : out.results) {
    if (result.source != DepthSource::kLidar) continue;
    ++refined;
    EXPECT_NEAR(result.accumulation_s, 0.4, 0.011);
    EXPECT_EQ(result.predictions, GetParam() ? 5 : 4) << "0 1 2 3 4 or 0 1 2 4 packets";
  }
  EXPECT_GT(refined, 40);
  EXPECT_EQ(net->encoded, images_in(messages)) << "an image is encoded once, however often it is refined";
}

TEST(DepthEngine, ANewerImageEndsTheRefinementOfOlderOnesIfAsked) {
  LevelWorld world(kHeight_m);
  const auto messages = fakes::flight(world, {3.0});
  const auto net = [] {
    return std::make_shared<FakePredictor>(
        [](int points) { return points > 5500 ? kHeight_m : 1.4 * kHeight_m; });
  };
  DepthEngineConfig config = config_of(true);  // waits for the LiDAR after the image, 0.4 s of it
  config.newer_image = NewerImage::kLatest;
  const Outcome latest = run(config, messages, net());
  expect_complete(latest, messages);
  for (std::size_t i = 0; i + 1 < latest.results.size(); ++i) {
    EXPECT_EQ(latest.results[i].source, DepthSource::kNone);
    EXPECT_NE(latest.results[i].reason.find("a newer image came"), std::string::npos);
  }
  // Who has the LiDAR of the second before has no older images to end.
  config = config_of(false);
  const Outcome finish = run(config, messages, net());
  config.newer_image = NewerImage::kLatest;
  const Outcome with_history = run(config, messages, net());
  ASSERT_EQ(with_history.results.size(), finish.results.size());
  for (std::size_t i = 0; i < finish.results.size(); ++i) {
    if (finish.results[i].t_ns < kStart_ns + 1100 * kMillisecond) continue;
    EXPECT_EQ(with_history.results[i].source, finish.results[i].source) << i;
  }
}

TEST_P(DepthEngineModes, NeverRightFallsBackAfterOneSecondOfLidar) {
  LevelWorld world(kHeight_m);
  const auto messages = fakes::flight(world, {3.0});
  const Outcome out = run(config_of(GetParam()), messages, always(1.3 * kHeight_m));
  expect_complete(out, messages);
  int fallbacks = 0;
  for (const DepthResult& result : out.results) {
    EXPECT_NE(result.source, DepthSource::kImage);
    EXPECT_NE(result.source, DepthSource::kLidar);
    if (result.source != DepthSource::kFallback || result.t_ns > kStart_ns + 1900 * kMillisecond) continue;
    ++fallbacks;
    EXPECT_NEAR(result.accumulation_s, 1.0, 0.011);
    cv::Mat error = cv::abs(result.depth_m - kHeight_m);
    error.setTo(0, result.depth_m == 0);
    EXPECT_LT(cv::norm(error, cv::NORM_INF), 0.01);
    EXPECT_EQ(result.depth_m.at<float>(2, 2), 0) << "outside the LiDAR's circle";
    EXPECT_EQ(result.pixel_source.at<std::uint8_t>(72, 80), static_cast<int>(PixelSource::kInterpolated));
    EXPECT_NE(result.reason.find("not trusted"), std::string::npos);
  }
  EXPECT_GT(fallbacks, 15);
}

TEST_P(DepthEngineModes, WithoutANetworkTheLidarIsInterpolated) {
  LevelWorld world(kHeight_m);
  const auto messages = fakes::flight(world, {3.0});
  const Outcome out = run(config_of(GetParam()), messages, nullptr);
  expect_complete(out, messages);
  for (const DepthResult& result : out.results) {
    EXPECT_EQ(result.predictions, 0);
    const double t_s = to_seconds(result.t_ns - kStart_ns);
    if (t_s < 1.8 || !GetParam())
      EXPECT_EQ(result.source, DepthSource::kFallback) << t_s << " " << result.reason;
  }
}

TEST_P(DepthEngineModes, SameMessagesSameResults) {
  const auto once = [&] {
    LevelWorld world(kHeight_m);
    const auto messages = fakes::flight(world, {2.5});
    return run(config_of(GetParam()), messages, std::make_shared<FakePredictor>([](int points) {
                 return kHeight_m * (1 + 200.0 / (points + 500));
               }));
  };
  const Outcome a = once();
  const Outcome b = once();
  ASSERT_EQ(a.results.size(), b.results.size());
  for (std::size_t i = 0; i < a.results.size(); ++i) {
    const DepthResult& x = a.results[i];
    const DepthResult& y = b.results[i];
    EXPECT_EQ(x.source, y.source);
    EXPECT_EQ(x.reason, y.reason);
    EXPECT_EQ(x.accumulation_s, y.accumulation_s);
    EXPECT_EQ(x.stereo.sim_pred, y.stereo.sim_pred);
    EXPECT_EQ(x.holdout.rms_m, y.holdout.rms_m);
    ASSERT_EQ(x.depth_m.empty(), y.depth_m.empty());
    if (!x.depth_m.empty()) EXPECT_EQ(cv::norm(x.depth_m, y.depth_m, cv::NORM_INF), 0);
  }
}

TEST_P(DepthEngineModes, WithoutLidarStereoAloneDecides) {
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

TEST_P(DepthEngineModes, WithoutTheRightEyeTheHoldoutDecides) {
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

TEST_P(DepthEngineModes, WithoutPosesEveryImageSaysSo) {
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
  EXPECT_GT(out.dropped.at("LiDAR point without pose"), 0);
}

TEST_P(DepthEngineModes, LateMessagesAreWaitedFor) {
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
  EXPECT_GT(out.dropped.at("LiDAR point without pose"), 2000);
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

/// Right from four packets on. Images begin where the one before ended, every fourth with half; in the end each costs one
/// prediction, that one two.
TEST(DepthEngine, WarmImagesBeginWhereTheLastOneEnded) {
  LevelWorld world(kHeight_m);
  DepthEngineConfig config = config_of(false);
  config.image.warm_images = 3;
  const auto messages = fakes::flight(world, {6.0});
  const auto net =
      std::make_shared<FakePredictor>([](int points) { return points > 5500 ? kHeight_m : 1.4 * kHeight_m; });
  const Outcome out = run(config, messages, net);
  expect_complete(out, messages);
  std::map<int, int> predictions;
  for (const DepthResult& result : out.results) {
    if (result.t_ns < kStart_ns + 2000 * kMillisecond || result.source != DepthSource::kLidar) continue;
    EXPECT_NEAR(result.accumulation_s, 0.4, 0.011);
    ++predictions[result.predictions];
  }
  EXPECT_EQ(predictions.size(), 2U);
  EXPECT_NEAR(predictions[1], 3 * predictions[2], 4);
}

TEST(DepthEngine, AfterAFallbackTheNetworkRests) {
  LevelWorld world(kHeight_m);
  DepthEngineConfig config = config_of(false);
  config.image.warm_images = 3;
  const auto messages = fakes::flight(world, {6.0});
  const Outcome out = run(config, messages, always(1.3 * kHeight_m));
  expect_complete(out, messages);
  std::map<int, int> predictions;
  for (const DepthResult& result : out.results) {
    if (result.t_ns < kStart_ns + 2000 * kMillisecond || result.source != DepthSource::kFallback) continue;
    EXPECT_NEAR(result.accumulation_s, 1.0, 0.011);
    ++predictions[result.predictions];
  }
  EXPECT_NEAR(predictions[0], 3 * predictions[1], 4);
  EXPECT_GT(predictions[1], 10);
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

TEST(DepthEngine, NothingAtAll) {
  DepthEngine engine(config_of(false), fakes::small_rig(), nullptr);
  engine.finish();
  EXPECT_TRUE(engine.take_results().empty());
}

TEST(DepthEngine, HoldsNoMoreThanAFewSecondsOfAnEndlessFlight) {
  LevelWorld world(kHeight_m);
  DepthEngineConfig config = config_of(true);
  config.max_open_images = 5;
  DepthEngine engine(config, fakes::small_rig(), always(1.4 * kHeight_m));
  std::size_t most = 0;
  std::size_t results = 0;
  for (const LogMessage& message : fakes::flight(world, {20.0, 5})) {
    engine.add(message);
    results += engine.take_results().size();
    most = std::max(most, engine.images_in_flight());
    EXPECT_LE(engine.points_held(), 2000U * 45U);
  }
  EXPECT_LE(most, 12U);
  EXPECT_GT(results, 80U);
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
