#include "train/data/sample_source.hpp"

#include <string>
#include <utility>

#include <spdlog/spdlog.h>

namespace alight {

DatasetSource::DatasetSource(const std::filesystem::path& dir, const SplitConfig& split, SplitPart part,
                             bool with_dense)
    : dataset_(dir, DepthDatasetOptions{{}, with_dense}) {
  std::vector<SampleTime> samples;
  for (std::size_t i = 0; i < *dataset_.size(); ++i)
    samples.push_back({dataset_.flight(i).name, dataset_.row(i).t_ns});
  SampleSplit parts = choose(samples, split);
  const double window_s = dataset_.info().window_before_s + dataset_.info().window_after_s;
  if (const std::string leak = leak_through_gap(split, window_s);
      part == SplitPart::kTraining && !leak.empty())
    spdlog::warn(leak);
  chosen_ = std::move(part == SplitPart::kTraining  ? parts.training
                      : part == SplitPart::kHeldOut ? parts.held_out
                                                    : parts.unknown);
}

}  // namespace alight
