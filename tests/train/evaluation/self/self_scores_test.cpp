#include "train/evaluation/self/self_scores.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/train/evaluation/evaluation_scenes.hpp"

namespace alight {
namespace {

torch::Tensor perfect_depth(const DepthSample& sample, const torch::Tensor&) { return sample.dense.clone(); }
/// Believes the height, as a network does that has nothing else.
torch::Tensor level_tensor(const DepthSample& sample, const torch::Tensor&) {
  return torch::full_like(sample.dense, sample.height_m - 1);
}

const std::vector<EvaluationItem> kScoredItems{{0, "a_1"}, {1, "b_1"}};

SelfScoreConfig small_score_config() {
  SelfScoreConfig config;
  config.windows_s = {0, 0.5};
  config.good = {{0.9, 0.1, 0.01}, {0.8, 0.1, 0.01}};
  config.holdout_s = 0.25;
  config.threads = 2;
  return config;
}

std::vector<MapScores> scores_of(test::FakeMethod::Function function,
                                 const SelfScoreConfig& config = small_score_config()) {
  auto source = test::scenes(2);
  return score_maps(test::FakeMethod("fake", std::move(function)), source, kScoredItems, test::scene_rig(),
                    config);
}

const MapScores& find(const std::vector<MapScores>& maps, MapOrigin origin, double window_s) {
  for (const MapScores& map : maps) {
    if (map.origin == origin && map.window_s == window_s) return map;
  }
  throw std::runtime_error("there is no such map");
}

TEST(ShareWithin, TheLargerToleranceCountsAndUnknownIsWrong) {
  const cv::Mat truth_m = (cv::Mat_<float>(1, 5) << 5, 20, 20, 10, 0);
  const cv::Mat predicted_m =
      (cv::Mat_<float>(1, 5) << 5.09F, 20.19F, 20.21F, std::numeric_limits<float>::quiet_NaN(), 3);
  EXPECT_EQ(share_within(predicted_m, truth_m, GoodDepth{0.95, 0.1, 0.01}), 0.5);
  EXPECT_EQ(share_within(predicted_m, truth_m, GoodDepth{0.95, 0.1, 0.02}), 0.75);
  EXPECT_EQ(share_within(predicted_m, truth_m, GoodDepth{0.95, 0.05, 0}), 0);
  EXPECT_EQ(share_within(predicted_m * 0, truth_m, GoodDepth{0.95, 100, 100}), 0);
  EXPECT_EQ(share_within(predicted_m, truth_m * 0, GoodDepth{}), 0);
}

TEST(ScoreMaps, EveryKindOnceAWindowAndInTheOrderOfTheItems) {
  const std::vector<MapScores> maps = scores_of(perfect_depth);
  ASSERT_EQ(maps.size(), 2U * (5 + 6));  // without LiDAR there is nothing to interpolate
  EXPECT_EQ(maps.front().flight, "a_1");
  EXPECT_EQ(maps.back().flight, "b_1");
  EXPECT_EQ(maps.back().origin, MapOrigin::kDelaunay);
}

TEST(ScoreMaps, PerfectDepthIsGoodAndAcceptedByTheHoldOutTest) {
  const std::vector<MapScores> maps = scores_of(perfect_depth);
  for (const double window_s : {0.0, 0.5}) {
    const MapScores& map = find(maps, MapOrigin::kNetwork, window_s);
    EXPECT_EQ(map.share_within, (std::vector<double>{1, 1}));
    EXPECT_TRUE(map.good[0]);
    EXPECT_EQ(map.holdout_verdict, Verdict::kAccept);
    EXPECT_EQ(map.holdout.median_m, 0);
    EXPECT_TRUE(map.stereo.sim && map.stereo.sim_d && map.stereo.sim_pred && map.stereo.peak);
  }
}

TEST(ScoreMaps, StretchedDepthIsAsWrongAsItIsStretched) {
  const std::vector<MapScores> maps = scores_of(perfect_depth);
  for (const MapOrigin origin : {MapOrigin::kTooFar, MapOrigin::kTooNear}) {
    const MapScores& map = find(maps, origin, 0.5);
    EXPECT_NEAR(map.holdout.median_relative, 0.1, 1e-5) << name(origin);
    EXPECT_NEAR(map.holdout.rms_relative, 0.1, 1e-5) << name(origin);
    EXPECT_EQ(map.holdout_verdict, Verdict::kReject) << name(origin);
    EXPECT_FALSE(map.good[0]) << name(origin);
  }
}

TEST(ScoreMaps, TheWrongHeightReachesTheNetworkAndNoOtherMap) {
  const std::vector<MapScores> maps = scores_of(level_tensor);
  const MapScores& right = find(maps, MapOrigin::kNetwork, 0);
  EXPECT_GT(right.share_within[0], 0.9);  // all but the block
  EXPECT_EQ(find(maps, MapOrigin::kWrongHeight, 0).share_within[0], 0);
}

TEST(ScoreMaps, TheHoldOutIsTheNextPacketAndWasNotFed) {
  auto source = test::scenes(2);
  const DepthSample sample = source.get(0);
  const torch::Tensor there = sample.sparse > 0;
  const auto within = [&](double begin_s, double end_s) {
    return (there & (sample.offset_s >= begin_s) & (sample.offset_s < end_s)).sum().item<int>();
  };
  const std::vector<MapScores> maps = scores_of(perfect_depth);
  EXPECT_EQ(find(maps, MapOrigin::kNetwork, 0).holdout.points, within(0, 0.25));
  EXPECT_EQ(find(maps, MapOrigin::kNetwork, 0.5).holdout.points, within(0.5, 0.75));
}

TEST(ScoreMaps, ASampleWithoutDenseTruthIsRefusedByName) {
  std::vector<DepthSample> samples{test::scene_sample(0)};
  samples[0].dense = torch::Tensor();
  test::MemorySource source(std::move(samples));
  try {
    score_maps(test::FakeMethod("fake", level_tensor), source, {{0, "real"}}, test::scene_rig(),
               small_score_config());
    FAIL() << "was not refused";
  } catch (const DataError& error) {
    EXPECT_NE(std::string(error.what()).find("flight real, sample 0"), std::string::npos) << error.what();
  }
}

TEST(ScoreMaps, MonoSamplesHaveNoStereoEvidence) {
  std::vector<DepthSample> samples{test::scene_sample(0)};
  samples[0].has_right = false;
  test::MemorySource source(std::move(samples));
  const auto maps = score_maps(test::FakeMethod("fake", perfect_depth), source, {{0, "a"}}, test::scene_rig(),
                               small_score_config());
  for (const MapScores& map : maps) {
    EXPECT_FALSE(map.stereo.sim);
    EXPECT_EQ(map.stereo_verdict, Verdict::kNoEvidence);
  }
}

}  // namespace
}  // namespace alight
