#pragma once

#include <string>
#include <vector>

#include "train/data/sample_source.hpp"
#include "train/evaluation/scores/evaluation_config.hpp"

namespace alight {

/// All samples of a data set, with their dense truth; which of them are judged is chosen by index.
class WholeDataset : public SampleSource {
 public:
  /// @throws DataError as DepthDataset
  explicit WholeDataset(const std::string& dir)
      : dataset_(dir, DepthDatasetOptions{{}, /*with_dense=*/true}) {}
  std::size_t size() const override { return *dataset_.size(); }
  DepthSample get(std::size_t index) override { return dataset_.get(index); }
  const DepthDataset& dataset() const { return dataset_; }

 private:
  DepthDataset dataset_;
};

/// Each sample's flight and time, in nanoseconds.
std::vector<SampleTime> sample_times(const DepthDataset& dataset);

/// The names of the flights, for readers.
std::string flight_list(const std::vector<EvaluationItem>& items);

}  // namespace alight
