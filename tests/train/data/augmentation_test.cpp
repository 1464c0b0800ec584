#include "train/data/augmentation.hpp"

#include <array>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "tests/train/data/ground_scene.hpp"
#include "train/data/batch_geometry.hpp"
#include "train/data/density_sampling.hpp"

namespace alight {
namespace {

using test::ground_scene;
using test::GroundSceneOptions;
using test::photometric;

constexpr torch::Tensor Batch::* kFields[] = {&Batch::left,          &Batch::right,
                                              &Batch::previous,      &Batch::next,
                                              &Batch::sparse_m,      &Batch::offset_s,
                                              &Batch::has_right,     &Batch::has_previous,
                                              &Batch::has_next,      &Batch::T_previous_camera,
                                              &Batch::T_next_camera, &Batch::intrinsics_px,
                                              &Batch::baseline_m,    &Batch::height_m,
                                              &Batch::down_camera};

bool equal(const Batch& a, const Batch& b) {
  for (const auto field : kFields) {
    if (!torch::equal(a.*field, b.*field)) return false;
  }
  return true;
}

Batch part(const Batch& batch, std::int64_t begin, std::int64_t end) {
  Batch out = batch;
  for (const auto field : kFields) out.*field = (batch.*field).slice(0, begin, end);
  return out;
}

/// The ground `count` times.
Batch grounds(std::int64_t count, const GroundSceneOptions& options = {}) {
  Batch batch = ground_scene(options).batch;
  for (const auto field : kFields) {
    batch.*field = torch::cat(std::vector<torch::Tensor>(static_cast<std::size_t>(count), batch.*field));
  }
  return batch;
}

AugmentationConfig all_of(double probability) {
  AugmentationConfig c;
  c.horizontal_flip_probability = c.vertical_flip_probability = probability;
  c.quarter_turn_probability = c.jitter_probability = probability;
  return c;
}

AugmentationConfig jitter_only() {
  AugmentationConfig c;
  c.jitter_probability = 1;
  return c;
}

TEST(Augmentation, OffGivesTheBatchItself) {
  const Batch batch = grounds(2);
  const Batch same = augment(batch, {}, {1, 2, 0});
  for (const auto field : kFields) EXPECT_TRUE((same.*field).is_same(batch.*field));
  EXPECT_EQ(same.indices, batch.indices);
}

TEST(Augmentation, AppliesWhatTheConfigurationSays) {
  GroundSceneOptions wide;
  wide.width_px = 58;
  const Batch batch = grounds(1, wide);
  AugmentationConfig c;
  c.horizontal_flip_probability = 1;
  EXPECT_TRUE(equal(augment(batch, c, {}), flip_horizontally(batch)));
  c.vertical_flip_probability = 1;
  EXPECT_TRUE(equal(augment(batch, c, {}), flip_vertically(flip_horizontally(batch))));
}

TEST(Augmentation, TurnsByOneTwoOrThreeQuarters) {
  AugmentationConfig c;
  c.quarter_turn_probability = 1;
  const Batch one = grounds(1);
  const Batch turned = augment(grounds(90), c, {3, 0, 0});
  std::array<int, 4> count{};
  for (std::int64_t i = 0; i < 90; ++i) {
    for (int quarters = 1; quarters <= 3; ++quarters) {
      count.at(static_cast<std::size_t>(quarters)) +=
          static_cast<int>(equal(part(turned, i, i + 1), turn(one, quarters)));
    }
  }
  EXPECT_EQ(count[1] + count[2] + count[3], 90);
  for (const int quarters : {1, 2, 3}) EXPECT_NEAR(count.at(static_cast<std::size_t>(quarters)), 30, 14);
}

TEST(Augmentation, ProbabilityIsHowOften) {
  AugmentationConfig c;
  c.vertical_flip_probability = 0.25;
  const Batch out = augment(grounds(400), c, {5, 1, 0});
  const torch::Tensor flipped = out.down_camera.select(1, 1) > 0;  // negative in the scene
  EXPECT_NEAR(flipped.to(torch::kFloat64).mean().item<double>(), 0.25, 0.07);
}

TEST(Augmentation, PartsOfABatchDrawWhatTheWholeDraws) {
  const Batch batch = grounds(6);
  const Batch whole = augment(batch, all_of(0.5), {9, 4, 0});
  EXPECT_TRUE(equal(part(whole, 0, 2), augment(part(batch, 0, 2), all_of(0.5), {9, 4, 0})));
  EXPECT_TRUE(equal(part(whole, 2, 6), augment(part(batch, 2, 6), all_of(0.5), {9, 4, 2})));
  EXPECT_FALSE(equal(whole, augment(batch, all_of(0.5), {9, 5, 0})));
  EXPECT_FALSE(equal(whole, augment(batch, all_of(0.5), {8, 4, 0})));
  EXPECT_EQ(whole.indices, batch.indices);
}

TEST(Augmentation, DrawsApartFromTheDensities) {
  // The first number of either draw decides: in one stream every flipped sample would go without points.
  constexpr std::int64_t kCount = 400;
  const Batch batch = grounds(kCount);
  AugmentationConfig c;
  c.horizontal_flip_probability = 0.5;
  DensitySamplingConfig density;
  density.draw = DensityDraw::kSample;
  density.no_lidar_probability = 0.5;
  const DrawKey key{2, 7, 0};
  const torch::Tensor flipped = augment(batch, c, key).down_camera.select(1, 0) < 0;
  const torch::Tensor without =
      sample_density(batch.left, batch.right, batch.sparse_m, batch.offset_s, density, key)
          .sparse_m.amax({1, 2, 3}) == 0;
  EXPECT_NEAR((flipped == without).to(torch::kFloat64).mean().item<double>(), 0.5, 0.1);
}

TEST(Augmentation, JitterChangesAllViewsByTheSameMap) {
  Batch batch = grounds(8);
  // Half of what they see is common, so that their means differ.
  batch.right = batch.previous = batch.next = torch::constant_pad_nd(batch.left.slice(3, 22), {22, 0}, 0.9);
  const Batch out = augment(batch, jitter_only(), {1, 0, 0});
  for (const torch::Tensor& view : {out.right, out.previous, out.next}) {
    EXPECT_TRUE(torch::equal(view.slice(3, 22), out.left.slice(3, 22)));
  }
  EXPECT_TRUE(torch::equal(out.sparse_m, batch.sparse_m));
  EXPECT_TRUE(torch::equal(out.T_next_camera, batch.T_next_camera));
  std::set<float> means;
  for (std::int64_t i = 0; i < 8; ++i) means.insert(out.left[i].mean().item<float>());
  EXPECT_EQ(means.size(), 8U);
}

TEST(Augmentation, JitterLeavesTheTrueDepthTheBest) {
  // Three factors of at most 1.2 enlarge differences of colour by at most 1.73.
  const test::GroundScene scene = ground_scene();
  const double before = photometric(scene.batch, scene.left_depth_m, true, true, true);
  for (std::int64_t step = 0; step < 20; ++step) {
    const Batch out = augment(scene.batch, jitter_only(), {1, step, 0});
    EXPECT_LT(photometric(out, scene.left_depth_m, true, true, true), 1.73 * before);
    Batch wrong = scene.batch;
    wrong.left = out.left;
    EXPECT_GT(photometric(wrong, scene.left_depth_m, true, true, true), 1.73 * before);
  }
}

TEST(Augmentation, JitterFactorsByHand) {
  Batch batch = grounds(64);
  batch.left = torch::full_like(batch.left, 0.5);  // grey: contrast and saturation change nothing
  AugmentationConfig c = jitter_only();
  const torch::Tensor grey = augment(batch, c, {1, 0, 0}).left;
  EXPECT_LE(grey.max().item<float>(), 0.6F + 1e-6F);
  EXPECT_GE(grey.min().item<float>(), 0.4F - 1e-6F);
  EXPECT_GT((grey.max() - grey.min()).item<float>(), 0.15);

  batch = grounds(64);
  c.max_brightness = c.max_saturation = 0;
  c.max_contrast = 1;
  const torch::Tensor out = augment(batch, c, {1, 0, 0}).left;
  EXPECT_GE(out.min().item<float>(), 0);
  EXPECT_LE(out.max().item<float>(), 1);
  EXPECT_GT((out == 1).sum().item<int>(), 0);  // clamped
  EXPECT_LT(out.std({1, 2, 3}).min().item<float>(), 0.2 * batch.left.std().item<float>());

  c.max_contrast = 0;
  c.max_saturation = 1;
  const auto luma = [](const torch::Tensor& x) {
    return 0.299 * x.select(1, 0) + 0.587 * x.select(1, 1) + 0.114 * x.select(1, 2);
  };
  batch.left = 0.35 + 0.3 * batch.left;  // nothing reaches the limits
  const torch::Tensor coloured = augment(batch, c, {1, 0, 0}).left;
  EXPECT_TRUE(torch::allclose(luma(coloured), luma(batch.left), 0, 1e-5));
  EXPECT_FALSE(torch::allclose(coloured, batch.left, 0, 0.05));
}

TEST(Augmentation, AbsentViewsStayBlack) {
  Batch batch = grounds(4);
  batch.right.zero_();
  batch.previous.zero_();
  batch.has_right.zero_();
  batch.has_previous.zero_();
  const Batch out = augment(batch, all_of(1), {1, 0, 0});
  EXPECT_EQ(out.right.abs().max().item<float>(), 0);
  EXPECT_EQ(out.previous.abs().max().item<float>(), 0);
  EXPECT_GT(out.next.min().item<float>(), 0);
}

TEST(Augmentation, RefusesToTurnWhatIsNotSquare) {
  GroundSceneOptions wide;
  wide.width_px = 58;
  AugmentationConfig c;
  c.quarter_turn_probability = 0.01;
  EXPECT_THROW(augment(grounds(1, wide), c, {}), std::invalid_argument);
}

TEST(Augmentation, ProbabilitiesAreBounded) {
  for (const std::string key :
       {"horizontal_flip_probability", "vertical_flip_probability", "quarter_turn_probability",
        "jitter_probability", "max_brightness", "max_contrast", "max_saturation"}) {
    EXPECT_NO_THROW(parse_config<AugmentationConfig>(key + ": 1", "test"));
    EXPECT_THROW(parse_config<AugmentationConfig>(key + ": 1.01", "test"), ConfigError) << key;
    EXPECT_THROW(parse_config<AugmentationConfig>(key + ": -0.01", "test"), ConfigError) << key;
  }
}

}  // namespace
}  // namespace alight
