#include "train/data/batch_geometry.hpp"

#include <array>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/inputs/altitude_plane.hpp"
#include "tests/train/data/ground_scene.hpp"

namespace alight {
namespace {

using test::ground_scene;
using test::GroundScene;
using test::GroundSceneOptions;
using test::photometric;

GroundSceneOptions wide() {
  GroundSceneOptions o;
  o.height_px = 41;
  o.width_px = 58;
  return o;
}

GroundSceneOptions mono() {
  GroundSceneOptions o = wide();
  o.has_right = false;
  return o;
}

/// A move of the pixels, and the true depth of what is the left view after it, moved by torch alone.
struct Move {
  const char* name;
  GroundSceneOptions scene;
  std::function<Batch(const Batch&)> apply;
  std::function<torch::Tensor(const GroundScene&)> true_depth_m;
};
std::ostream& operator<<(std::ostream& out, const Move& move) { return out << move.name; }

class BatchGeometryMoves : public testing::TestWithParam<Move> {
 protected:
  const GroundScene before_ = ground_scene(GetParam().scene);
  const Batch after_ = GetParam().apply(before_.batch);
  const torch::Tensor depth_m_ = GetParam().true_depth_m(before_);
};

TEST_P(BatchGeometryMoves, TrueDepthStillRebuildsTheViews) {
  for (const std::array<bool, 3> use : std::vector<std::array<bool, 3>>{
           {true, false, false}, {false, true, false}, {false, false, true}, {true, true, true}}) {
    const double before = photometric(before_.batch, before_.left_depth_m, use[0], use[1], use[2]);
    const double after = photometric(after_, depth_m_, use[0], use[1], use[2]);
    EXPECT_LT(before, 0.002);  // what bilinear interpolation leaves
    EXPECT_LT(after, 1.2 * before + 1e-6) << use[0] << use[1] << use[2];
  }
}

TEST_P(BatchGeometryMoves, PosesThatStayBehindAreSeen) {
  Batch wrong = after_;
  wrong.T_previous_camera = before_.batch.T_previous_camera;
  EXPECT_GT(photometric(wrong, depth_m_, true, false, false), 0.02);
  wrong.T_next_camera = before_.batch.T_next_camera;
  EXPECT_GT(photometric(wrong, depth_m_, false, true, false), 0.02);
}

TEST_P(BatchGeometryMoves, LevelGroundStaysTheAltitudePlane) {
  const auto plane_m = [&](const Batch& b) {
    return altitude_planes(b.height_m, b.down_camera, b.intrinsics_px, b.left.size(2), b.left.size(3), 1000);
  };
  ASSERT_TRUE(torch::allclose(plane_m(before_.batch), before_.left_depth_m, 1e-5, 0));
  EXPECT_TRUE(torch::allclose(plane_m(after_), depth_m_, 1e-5, 0));
  Batch wrong = after_;
  wrong.down_camera = before_.batch.down_camera;
  EXPECT_FALSE(torch::allclose(plane_m(wrong), depth_m_, 1e-2, 0));
}

TEST_P(BatchGeometryMoves, PointsKeepTheirDepthAndOffset) {
  const torch::Tensor there = after_.sparse_m > 0;
  // Rounding to a pixel moves a point on a slope by half a pixel at most.
  const torch::Tensor step_m = depth_m_.diff(1, 3).abs().max();
  EXPECT_LT((after_.sparse_m - depth_m_).abs().masked_select(there).max().item<float>(),
            0.55 * step_m.item<float>());
  EXPECT_TRUE(torch::equal(after_.offset_s, after_.sparse_m * 0.01));
  EXPECT_GT(there.sum().item<int>(), 0.85 * (before_.batch.sparse_m > 0).sum().item<int>());
}

TEST_P(BatchGeometryMoves, GivenTensorsAreLeftAlone) {
  const GroundScene again = ground_scene(GetParam().scene);
  EXPECT_TRUE(torch::equal(before_.batch.left, again.batch.left));
  EXPECT_TRUE(torch::equal(before_.batch.sparse_m, again.batch.sparse_m));
  EXPECT_TRUE(torch::equal(before_.batch.T_next_camera, again.batch.T_next_camera));
  EXPECT_TRUE(torch::equal(before_.batch.intrinsics_px, again.batch.intrinsics_px));
  EXPECT_TRUE(torch::equal(before_.batch.has_right, again.batch.has_right));
  EXPECT_GT(after_.baseline_m.item<float>(), 0);
}

Batch quarters(const Batch& b, int count) { return turn(b, count); }
torch::Tensor turned(const torch::Tensor& x, std::int64_t quarters) { return x.rot90(quarters, {2, 3}); }

INSTANTIATE_TEST_SUITE_P(
    All, BatchGeometryMoves,
    testing::Values(Move{"horizontal", wide(), flip_horizontally,
                         [](const GroundScene& s) { return s.right_depth_m.flip(3); }},
                    Move{"horizontal_mono", mono(), flip_horizontally,
                         [](const GroundScene& s) { return s.left_depth_m.flip(3); }},
                    Move{"vertical", wide(), flip_vertically,
                         [](const GroundScene& s) { return s.left_depth_m.flip(2); }},
                    Move{"quarter",
                         {},
                         [](const Batch& b) { return quarters(b, 1); },
                         [](const GroundScene& s) { return turned(s.left_depth_m, 1); }},
                    Move{"half",
                         {},
                         [](const Batch& b) { return quarters(b, 2); },
                         [](const GroundScene& s) { return turned(s.right_depth_m, 2); }},
                    Move{"three_quarters",
                         {},
                         [](const Batch& b) { return quarters(b, 3); },
                         [](const GroundScene& s) { return turned(s.left_depth_m, 3); }}),
    [](const auto& move) { return std::string(move.param.name); });

TEST(BatchGeometry, HorizontalFlipSwapsTheCameras) {
  const GroundScene scene = ground_scene(wide());
  const Batch flipped = flip_horizontally(scene.batch);
  EXPECT_TRUE(torch::equal(flipped.left, scene.batch.right.flip(3)));
  EXPECT_TRUE(torch::equal(flipped.right, scene.batch.left.flip(3)));
  EXPECT_TRUE(torch::equal(flipped.previous, scene.batch.previous.flip(3)));

  // Mirroring both cameras without the swap leaves the second one on the wrong side.
  Batch wrong = flipped;
  std::swap(wrong.left, wrong.right);
  EXPECT_GT(photometric(wrong, scene.left_depth_m.flip(3), false, false, true), 0.02);

  // As do poses that are mirrored, but still those of the old camera.
  Batch mono = scene.batch;
  mono.has_right = torch::zeros_like(mono.has_right);
  wrong = flipped;
  wrong.T_previous_camera = flip_horizontally(mono).T_previous_camera;
  EXPECT_GT(photometric(wrong, scene.right_depth_m.flip(3), true, false, false), 0.02);
}

TEST(BatchGeometry, PointsMoveByTheirDisparity) {
  GroundSceneOptions o = wide();
  o.level_camera = true;
  const GroundScene scene = ground_scene(o);
  const Batch flipped = flip_horizontally(scene.batch);
  // 60 px * 0.5 m / 10 m = 3 px.
  const torch::Tensor expected = torch::constant_pad_nd(scene.batch.sparse_m.slice(3, 3), {0, 3}).flip(3);
  EXPECT_TRUE(torch::equal(flipped.sparse_m, expected));
  const torch::Tensor there = expected > 0;
  EXPECT_TRUE(torch::equal(expected, scene.right_depth_m.flip(3) * there));
}

TEST(BatchGeometry, NearestPointWinsAPixel) {
  Batch b = ground_scene(wide()).batch;
  b.sparse_m = torch::zeros_like(b.sparse_m);
  b.offset_s = torch::zeros_like(b.sparse_m);
  // 60 px * 0.5 m over 10, 4.9 and 5.3 m: 3, 6.1 and 5.7 px.
  for (const auto& [column, depth_m] : {std::pair{13, 10.0}, {16, 4.9}, {15, 5.3}}) {
    b.sparse_m[0][0][2][column] = depth_m;
    b.offset_s[0][0][2][column] = depth_m / 16;
  }
  const Batch flipped = flip_horizontally(b);
  const torch::Tensor depth_m = flipped.sparse_m.flip(3)[0][0][2];
  EXPECT_EQ(depth_m[10].item<float>(), 4.9F);
  EXPECT_EQ(flipped.offset_s.flip(3)[0][0][2][10].item<float>(), static_cast<float>(4.9 / 16));
  EXPECT_EQ(depth_m[9].item<float>(), 5.3F);
  EXPECT_EQ((flipped.sparse_m > 0).sum().item<int>(), 2);
}

void expect_same_views(const Batch& a, const Batch& b) {
  EXPECT_TRUE(torch::equal(a.left, b.left));
  EXPECT_TRUE(torch::equal(a.right, b.right));
  EXPECT_TRUE(torch::equal(a.previous, b.previous));
  EXPECT_TRUE(torch::equal(a.next, b.next));
  EXPECT_TRUE(torch::equal(a.intrinsics_px, b.intrinsics_px));
  EXPECT_TRUE(torch::equal(a.down_camera, b.down_camera));
  EXPECT_TRUE(torch::equal(a.has_right, b.has_right));
}

TEST(BatchGeometry, VerticalFlipTwiceIsTheOriginalBitForBit) {
  const Batch b = ground_scene(wide()).batch;
  const Batch twice = flip_vertically(flip_vertically(b));
  expect_same_views(twice, b);
  EXPECT_TRUE(torch::equal(twice.sparse_m, b.sparse_m));
  EXPECT_TRUE(torch::equal(twice.offset_s, b.offset_s));
  EXPECT_TRUE(torch::equal(twice.T_previous_camera, b.T_previous_camera));
  EXPECT_TRUE(torch::equal(twice.T_next_camera, b.T_next_camera));
  EXPECT_TRUE(torch::equal(twice.height_m, b.height_m));
}

TEST(BatchGeometry, HorizontalFlipTwiceLosesOnlyPointsThatOneCameraSees) {
  const Batch b = ground_scene(wide()).batch;
  const Batch twice = flip_horizontally(flip_horizontally(b));
  expect_same_views(twice, b);
  EXPECT_TRUE(torch::allclose(twice.T_previous_camera, b.T_previous_camera, 0, 1e-6));
  EXPECT_TRUE(torch::allclose(twice.T_next_camera, b.T_next_camera, 0, 1e-6));
  EXPECT_TRUE(torch::allclose(twice.height_m, b.height_m, 1e-6));
  const torch::Tensor kept = twice.sparse_m > 0;
  EXPECT_TRUE(torch::equal(twice.sparse_m, b.sparse_m * kept));
  EXPECT_GT(kept.sum().item<int>(), 0.85 * (b.sparse_m > 0).sum().item<int>());
}

TEST(BatchGeometry, FourQuartersAreTheOriginal) {
  GroundSceneOptions o;
  o.has_right = false;
  const Batch b = ground_scene(o).batch;
  for (const Batch& round : {turn(turn(b, 1), 3), turn(turn(turn(b, 1), 1), 2)}) {
    expect_same_views(round, b);
    EXPECT_TRUE(torch::equal(round.sparse_m, b.sparse_m));
    EXPECT_TRUE(torch::equal(round.T_next_camera, b.T_next_camera));
  }
}

TEST(BatchGeometry, QuarterTurnsGoWithoutTheRightCamera) {
  const Batch b = ground_scene().batch;
  for (const int odd : {1, 3}) {
    const Batch turned = turn(b, odd);
    EXPECT_FALSE(turned.has_right.item<bool>());
    EXPECT_EQ(turned.right.abs().max().item<float>(), 0);
  }
  EXPECT_TRUE(turn(b, 2).has_right.item<bool>());
}

TEST(BatchGeometry, RefusesWhatItCannotTurn) {
  EXPECT_THROW(turn(ground_scene(wide()).batch, 1), std::invalid_argument);
  EXPECT_THROW(turn(ground_scene().batch, 4), std::invalid_argument);
  Batch two = ground_scene().batch;
  two.left = two.left.repeat({2, 1, 1, 1});
  EXPECT_THROW(flip_horizontally(two), std::invalid_argument);
}

}  // namespace
}  // namespace alight
