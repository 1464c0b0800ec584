#include "train/data/batch_loader.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <stdexcept>

#include "foundation/errors.hpp"

namespace alight {
namespace {

/// Uniform in [0, 1); std::uniform_real_distribution differs between standard libraries.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

/// Fisher-Yates; std::shuffle differs between standard libraries.
void shuffle(std::vector<std::size_t>& order, std::mt19937_64& random) {
  for (std::size_t i = order.size(); i > 1; --i) {
    std::swap(order[i - 1], order[static_cast<std::size_t>(uniform(random) * static_cast<double>(i))]);
  }
}

std::int64_t place(double share, std::int64_t room) {
  return static_cast<std::int64_t>(share * static_cast<double>(std::max<std::int64_t>(room, 0) + 1));
}

}  // namespace

BatchLoader::BatchLoader(SampleCache& cache, const BatchLoaderOptions& options, int epoch,
                         std::size_t first_batch)
    : cache_(cache), options_(options), epoch_(epoch), started_(first_batch) {
  const auto batch_size = static_cast<std::size_t>(options.batch_size);
  if (cache.size() < batch_size) {
    throw DataError("training has " + std::to_string(cache.size()) + " samples, fewer than a batch of " +
                    std::to_string(batch_size) +
                    "; leave more of the data set to training (split), or lower train.batch_size");
  }
  std::seed_seq seed{options.seed, static_cast<std::uint64_t>(epoch)};
  std::mt19937_64 random(seed);
  const std::size_t steps =
      options.steps > 0 ? static_cast<std::size_t>(options.steps) : cache.size() / batch_size;
  std::vector<std::size_t> order;
  for (std::size_t step = 0; step < steps; ++step) {
    if (order.size() <
        batch_size) {  // the rest of a pass is dropped, as the samples of a batch should differ
      order.resize(cache.size());
      std::iota(order.begin(), order.end(), std::size_t{0});
      shuffle(order, random);
    }
    std::vector<Item> items;
    for (std::size_t i = 0; i < batch_size; ++i) {
      const double row_share = uniform(random);
      items.push_back({order.back(), row_share, uniform(random)});
      order.pop_back();
    }
    plan_.push_back(std::move(items));
  }
  keep_shard();
}

void BatchLoader::keep_shard() {
  if (options_.shards < 1 || options_.batch_size % options_.shards != 0) {
    throw std::invalid_argument("BatchLoader: expected a batch of equal shards");
  }
  const std::int64_t size = options_.batch_size / options_.shards;
  first_ = options_.shard * size;
  for (std::vector<Item>& items : plan_) items = {items.begin() + first_, items.begin() + first_ + size};
}

Batch BatchLoader::load(std::size_t number) const {
  const std::vector<Item>& items = plan_[number];
  std::vector<std::shared_ptr<const CompactSample>> samples;
  for (const Item& item : items) samples.push_back(cache_.get(item.sample));
  const std::int64_t height = options_.crop_px ? *options_.crop_px : samples.front()->height_px;
  const std::int64_t width = options_.crop_px ? *options_.crop_px : samples.front()->width_px;
  std::vector<CropOrigin> origins;
  for (std::size_t i = 0; i < items.size(); ++i) {
    origins.push_back({place(items[i].row_share, samples[i]->height_px - height),
                       place(items[i].column_share, samples[i]->width_px - width)});
  }
  const auto batches_before = static_cast<std::int64_t>(epoch_) * static_cast<std::int64_t>(plan_.size());
  return augment(stack(samples, origins, height, width), options_.augmentation,
                 {options_.seed, batches_before + static_cast<std::int64_t>(number), first_});
}

void BatchLoader::start_more() {
  while (started_ < plan_.size() && pending_.size() < static_cast<std::size_t>(options_.workers)) {
    pending_.push_back(std::async(std::launch::async, [this, step = started_] { return load(step); }));
    ++started_;
  }
}

std::optional<Batch> BatchLoader::next() {
  start_more();
  if (pending_.empty()) return std::nullopt;
  Batch batch = pending_.front().get();
  pending_.pop_front();
  start_more();
  return batch;
}

}  // namespace alight
