#include "train/data/batch.hpp"

#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/train/data/memory_source.hpp"

namespace alight {
namespace {

using test::random_image;
using test::scene_sample;

DepthSample noise_sample(std::int64_t index) {
  DepthSample sample = scene_sample(index, 11, 17);
  for (torch::Tensor* image : {&sample.left, &sample.right, &sample.previous, &sample.next})
    *image = random_image(11, 17);
  return sample;
}

std::shared_ptr<const CompactSample> compacted(const DepthSample& sample) {
  return std::make_shared<const CompactSample>(compact(sample));
}

TEST(Batch, WholeImagesComeBackBitForBit) {
  const DepthSample a = noise_sample(0);
  const DepthSample b = noise_sample(1);
  const Batch batch = stack({compacted(a), compacted(b)}, {{}, {}}, 11, 17);
  const auto pair = [](const torch::Tensor& x, const torch::Tensor& y) { return torch::stack({x, y}); };
  EXPECT_TRUE(torch::allclose(batch.left, pair(a.left, b.left), 0, 1e-7));
  EXPECT_TRUE(torch::allclose(batch.right, pair(a.right, b.right), 0, 1e-7));
  EXPECT_TRUE(torch::allclose(batch.previous, pair(a.previous, b.previous), 0, 1e-7));
  EXPECT_TRUE(torch::allclose(batch.next, pair(a.next, b.next), 0, 1e-7));
  EXPECT_TRUE(torch::equal(batch.sparse_m, pair(a.sparse, b.sparse)));
  EXPECT_TRUE(torch::equal(batch.offset_s, pair(a.offset_s, b.offset_s)));
  EXPECT_TRUE(torch::equal(batch.intrinsics_px, pair(a.intrinsics, b.intrinsics)));
  EXPECT_TRUE(batch.has_right.all().item<bool>());
  EXPECT_EQ(batch.height_m[1].item<float>(), static_cast<float>(b.height_m));
  EXPECT_TRUE(torch::equal(batch.down_camera, pair(a.down_camera, b.down_camera)));
  EXPECT_EQ(batch.indices, (std::vector<std::int64_t>{0, 1}));
}

TEST(Batch, CutOutsKeepTheGeometry) {
  const DepthSample sample = noise_sample(2);
  const Batch batch = stack({compacted(sample)}, {{3, 5}}, 8, 9);
  const auto cut = [](const torch::Tensor& x) { return x.slice(1, 3, 11).slice(2, 5, 14); };
  EXPECT_TRUE(torch::allclose(batch.left[0], cut(sample.left), 0, 1e-7));
  EXPECT_TRUE(torch::allclose(batch.next[0], cut(sample.next), 0, 1e-7));
  EXPECT_TRUE(torch::equal(batch.sparse_m[0], cut(sample.sparse)));
  const torch::Tensor moved = sample.intrinsics - torch::tensor({0.0F, 0.0F, 5.0F, 3.0F});
  EXPECT_TRUE(torch::equal(batch.intrinsics_px[0], moved));
}

TEST(Batch, AbsentViewsAreZeroAndMarked) {
  DepthSample sample = noise_sample(3);
  sample.has_right = sample.has_previous = false;
  const Batch batch = stack({compacted(sample)}, {{}}, 11, 17);
  EXPECT_FALSE(batch.has_right[0].item<bool>());
  EXPECT_FALSE(batch.has_previous[0].item<bool>());
  EXPECT_TRUE(batch.has_next[0].item<bool>());
  EXPECT_EQ(batch.right.abs().sum().item<double>(), 0);
}

TEST(Batch, TrueDepthDoesNotEnter) {
  const CompactSample small = compact(noise_sample(4));
  EXPECT_FALSE(small.rest.dense.defined());
}

TEST(Batch, CutOutThatDoesNotFitIsADataError) {
  EXPECT_THROW(stack({compacted(noise_sample(5))}, {{4, 0}}, 8, 9), DataError);
}

}  // namespace
}  // namespace alight
