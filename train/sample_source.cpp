#include "train/sample_source.hpp"

#include <utility>

namespace alight {

DatasetSource::DatasetSource(const std::filesystem::path& dir, const SplitConfig& split, SplitPart part,
                             bool with_dense)
    : dataset_(dir, DepthDatasetOptions{{}, with_dense}) {
  std::vector<SampleTime> samples;
  for (std::size_t i = 0; i < *dataset_.size(); ++i)
    samples.push_back({dataset_.flight(i).name, dataset_.row(i).t_ns});
  SampleSplit parts = choose(samples, split);
  chosen_ = std::move(part == SplitPart::kTraining  ? parts.training
                      : part == SplitPart::kHeldOut ? parts.held_out
                                                    : parts.unknown);
}

}  // namespace alight
