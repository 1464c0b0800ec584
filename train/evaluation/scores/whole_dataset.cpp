#include "train/evaluation/scores/whole_dataset.hpp"

namespace alight {

std::vector<SampleTime> sample_times(const DepthDataset& dataset) {
  std::vector<SampleTime> times;
  for (std::size_t i = 0; i < *dataset.size(); ++i)
    times.push_back({dataset.flight(i).name, dataset.row(i).t_ns});
  return times;
}

std::string flight_list(const std::vector<EvaluationItem>& items) {
  std::string list;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0 && items[i].flight == items[i - 1].flight) continue;
    list += (list.empty() ? "" : ", ") + items[i].flight;
  }
  return list;
}

}  // namespace alight
