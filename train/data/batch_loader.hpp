#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <optional>
#include <vector>

#include "train/data/augmentation.hpp"
#include "train/data/batch.hpp"

namespace alight {

/// How batches are made and loaded; of these, `workers` alone changes nothing in them.
struct BatchLoaderOptions {
  int batch_size = 16;
  int steps = 0;               ///< batches an epoch; 0: as many full batches as there are samples for
  std::optional<int> crop_px;  ///< side of a random square cut-out; none: whole images
  int workers = 1;             ///< batches prepared ahead, each in a thread of its own
  std::uint64_t seed = 0;
  AugmentationConfig augmentation;
  int shard = 0;  ///< of every batch, only this one of `shards` equal parts is read
  int shards = 1;
};

/// The batches of one epoch: every sample once in random order (again and again where `steps` asks for more),
/// prepared in the background. Order, cut-outs and augmentation depend on seed and epoch alone, not on threads or
/// shards: a batch of all shards is the one without them.
class BatchLoader {
 public:
  /// @param first_batch batches before it are left out: what a resumed run has behind it
  BatchLoader(SampleCache& cache, const BatchLoaderOptions& options, int epoch, std::size_t first_batch = 0);

  std::size_t batches() const { return plan_.size(); }
  /// The next batch, empty at the epoch's end. @throws DataError what happened while it was read
  std::optional<Batch> next();

 private:
  struct Item {
    std::size_t sample;
    double row_share, column_share;  // where in the room left the cut-out lies, 0..1
  };

  void keep_shard();
  Batch load(std::size_t number) const;
  void start_more();

  SampleCache& cache_;
  BatchLoaderOptions options_;
  int epoch_;
  std::vector<std::vector<Item>> plan_;
  std::int64_t first_ = 0;  // place of a part's first sample in its batch
  std::size_t started_ = 0;
  std::deque<std::future<Batch>> pending_;
};

}  // namespace alight
