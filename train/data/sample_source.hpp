#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "dataset/store/depth_dataset.hpp"
#include "train/data/split.hpp"

namespace alight {

/// Where training and validation get their samples.
class SampleSource {
 public:
  virtual ~SampleSource() = default;
  virtual std::size_t size() const = 0;
  /// Called from several threads at once. @throws DataError naming the file
  virtual DepthSample get(std::size_t index) = 0;
};

/// The part of a data set that a split gives to somebody.
enum class SplitPart { kTraining, kHeldOut, kUnknown };

/// Samples of a part of a data set on disk.
class DatasetSource : public SampleSource {
 public:
  /// @param with_dense for evaluation only. @throws DataError as DepthDataset, ConfigError as choose()
  DatasetSource(const std::filesystem::path& dir, const SplitConfig& split, SplitPart part, bool with_dense);
  std::size_t size() const override { return chosen_.size(); }
  DepthSample get(std::size_t index) override { return dataset_.get(chosen_.at(index)); }

 private:
  DepthDataset dataset_;
  std::vector<std::size_t> chosen_;  // index here -> index in the data set
};

}  // namespace alight
