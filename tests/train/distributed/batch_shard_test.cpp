#include <gtest/gtest.h>

#include "tests/train/data/memory_source.hpp"
#include "train/data/batch_loader.hpp"

namespace alight {
namespace {

/// Parts of a batch, put together, are the batch, augmentation included.
TEST(BatchShard, PartsMakeTheWholeBatch) {
  BatchLoaderOptions options;
  options.batch_size = 4;
  options.crop_px = 32;
  options.seed = 5;
  options.augmentation.horizontal_flip_probability = 0.5;
  options.augmentation.jitter_probability = 1;
  test::MemorySource source = test::scenes(9);
  SampleCache cache(source, 1U << 24U);
  BatchLoader whole(cache, options, 2);
  options.shards = 2;
  BatchLoader first(cache, options, 2);
  options.shard = 1;
  BatchLoader second(cache, options, 2);
  ASSERT_EQ(first.batches(), whole.batches());
  while (const std::optional<Batch> batch = whole.next()) {
    const Batch a = *first.next();
    const Batch b = *second.next();
    EXPECT_TRUE(torch::equal(torch::cat({a.left, b.left}), batch->left));
    EXPECT_TRUE(torch::equal(torch::cat({a.sparse_m, b.sparse_m}), batch->sparse_m));
    EXPECT_EQ(a.indices, std::vector<std::int64_t>(batch->indices.begin(), batch->indices.begin() + 2));
    EXPECT_EQ(b.indices, std::vector<std::int64_t>(batch->indices.begin() + 2, batch->indices.end()));
  }
}

TEST(BatchShard, UnequalPartsAreRefused) {
  BatchLoaderOptions options;
  options.batch_size = 3;
  options.shards = 2;
  test::MemorySource source = test::scenes(3);
  SampleCache cache(source, 1U << 24U);
  EXPECT_THROW(BatchLoader(cache, options, 1), std::invalid_argument);
}

}  // namespace
}  // namespace alight
