#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "foundation/binder_fwd.hpp"
#include "train/data/split.hpp"
#include "train/evaluation/methods/baseline_methods.hpp"
#include "train/evaluation/methods/feeding.hpp"
#include "train/evaluation/scores/regions.hpp"

namespace alight {

/// Which samples are judged (train/data/split.hpp).
enum class EvaluatedPart { kAll, kTraining, kHeldOut, kUnknown, kAllButTraining };
/// As in a configuration, such as held_out.
const char* name(EvaluatedPart part);

/// What is judged, by which methods and feedings.
struct EvaluationConfig {
  std::vector<std::string> flights;  ///< empty: all
  SplitConfig split;
  EvaluatedPart part = EvaluatedPart::kAll;
  int every = 1;                                                     ///< every n-th sample of a flight
  std::vector<double> shares{0, 0.1, 0.3, 0.5, 1.0};                 ///< P
  std::vector<double> windows_s{0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.4};  ///< accumulation windows
  std::int64_t seed = 1;
  int threads = 0;                        ///< samples judged at once; 0: all cores
  std::string picture_feeding = "P=0.3";  ///< what the worst samples are chosen and drawn by
  RegionConfig regions;
  BaselineConfig baselines;

  std::vector<Feeding> feedings() const { return make_feedings(shares, windows_s); }
};
void bind(Binder& b, EvaluationConfig& c);

/// A sample to judge.
struct EvaluationItem {
  std::size_t index = 0;  ///< of the data set
  std::string flight;
};

/// The samples that the configuration asks for. @param samples all of the data set, in its order
/// @throws ConfigError if a named flight is not there or nothing is left
std::vector<EvaluationItem> choose_items(const std::vector<SampleTime>& samples,
                                         const EvaluationConfig& config);

}  // namespace alight
