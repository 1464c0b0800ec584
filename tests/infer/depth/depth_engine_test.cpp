#include "infer/depth/depth_engine.hpp"

#include <map>

#include <gtest/gtest.h>

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
using fakes::kMillisecond;
using fakes::kStart_ns;
using fakes::LevelWorld;

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

}  // namespace
}  // namespace alight
