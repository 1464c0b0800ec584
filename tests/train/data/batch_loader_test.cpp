#include "train/data/batch_loader.hpp"

#include <set>

#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/train/data/memory_source.hpp"

namespace alight {
namespace {

using test::MemorySource;
using test::scenes;

BatchLoaderOptions options(int batch_size, int steps = 0, int workers = 1) {
  BatchLoaderOptions o;
  o.batch_size = batch_size;
  o.steps = steps;
  o.workers = workers;
  o.seed = 5;
  return o;
}

std::vector<Batch> read(MemorySource& source, const BatchLoaderOptions& o, int epoch,
                        std::size_t cache_bytes = 1U << 24U) {
  SampleCache cache(source, cache_bytes);
  BatchLoader loader(cache, o, epoch);
  std::vector<Batch> batches;
  while (std::optional<Batch> batch = loader.next()) batches.push_back(std::move(*batch));
  EXPECT_EQ(batches.size(), loader.batches());
  return batches;
}

/// Every scene has another depth: it tells which samples a batch holds.
std::vector<double> depths(const std::vector<Batch>& batches) {
  std::vector<double> found;
  for (const Batch& batch : batches) {
    const torch::Tensor deepest = batch.sparse_m.amax({1, 2, 3});
    for (std::int64_t i = 0; i < deepest.size(0); ++i) found.push_back(deepest[i].item<double>());
  }
  return found;
}

TEST(BatchLoader, EverySampleOnceInRandomOrder) {
  MemorySource source = scenes(7);
  const std::vector<double> first = depths(read(source, options(2), 1));
  EXPECT_EQ(first.size(), 6U);  // the odd one waits for another epoch
  EXPECT_EQ(std::set<double>(first.begin(), first.end()).size(), 6U);
  EXPECT_NE(first, depths(read(source, options(2), 2)));
}

TEST(BatchLoader, StepsLimitOrExtendAnEpoch) {
  MemorySource source = scenes(4);
  EXPECT_EQ(read(source, options(2, 1), 1).size(), 1U);
  EXPECT_EQ(read(source, options(2, 5), 1).size(), 5U);
}

TEST(BatchLoader, ThreadsAndCacheDoNotChangeTheBatches) {
  MemorySource source = scenes(8);
  BatchLoaderOptions one = options(2);
  one.crop_px = 32;
  BatchLoaderOptions many = one;
  many.workers = 4;
  const std::vector<Batch> expected = read(source, one, 3);
  const std::vector<Batch> threaded = read(source, many, 3, 0);
  ASSERT_EQ(expected.size(), threaded.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_TRUE(torch::equal(expected[i].left, threaded[i].left));
    EXPECT_TRUE(torch::equal(expected[i].sparse_m, threaded[i].sparse_m));
    EXPECT_TRUE(torch::equal(expected[i].intrinsics_px, threaded[i].intrinsics_px));
  }
}

TEST(BatchLoader, CutOutsMoveAround) {
  MemorySource source = scenes(8);
  BatchLoaderOptions o = options(1);
  o.crop_px = 32;
  std::set<double> columns;
  for (const Batch& batch : read(source, o, 1)) {
    EXPECT_EQ(batch.left.size(3), 32);
    columns.insert(batch.intrinsics_px[0][2].item<double>());
  }
  EXPECT_GT(columns.size(), 3U);
}

TEST(BatchLoader, FewerSamplesThanABatchIsADataError) {
  MemorySource source = scenes(3);
  SampleCache cache(source, 0);
  EXPECT_THROW(BatchLoader(cache, options(4), 1), DataError);
}

class BrokenSource : public MemorySource {
 public:
  using MemorySource::MemorySource;
  DepthSample get(std::size_t) override { throw DataError("left/000003.png: cannot be decoded"); }
};

TEST(BatchLoader, ErrorsOfTheBackgroundArrive) {
  BrokenSource source({test::scene_sample(0), test::scene_sample(1)});
  SampleCache cache(source, 0);
  BatchLoader loader(cache, options(1, 2, 2), 1);
  EXPECT_THROW(loader.next(), DataError);
}

TEST(SampleCache, StaysWithinItsLimit) {
  MemorySource source = scenes(4);
  const std::size_t one = compact(source.get(0)).bytes();
  SampleCache cache(source, 2 * one);
  for (std::size_t i = 0; i < 4; ++i) cache.get(i);
  EXPECT_EQ(cache.get(0), cache.get(0));
  EXPECT_EQ(cache.get(1), cache.get(1));
  EXPECT_NE(cache.get(3), cache.get(3));
}

}  // namespace
}  // namespace alight
