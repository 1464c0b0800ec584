#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "foundation/binder_fwd.hpp"
#include "foundation/errors.hpp"

namespace alight {

/// Which samples are learned from and which only judge (paper 4: familiar and unknown places).
struct SplitConfig {
  std::vector<std::string> unknown_flights;  ///< places that training never sees
  /// [begin, end) as shares of a flight's duration, held out of every flight that is trained on.
  std::vector<std::vector<double>> held_out_blocks;
  /// Samples nearer to a held-out block than this are left out of both parts: consecutive images show the same ground
  /// and share LiDAR points.
  double gap_s = 2;
};
void bind(Binder& b, SplitConfig& c);

/// Where a sample lies.
struct SampleTime {
  std::string flight;
  std::int64_t t_ns = 0;
};

/// Positions in the list that was split, ascending.
struct SampleSplit {
  std::vector<std::size_t> training;  ///< outside the blocks and gap_s or more away from them
  std::vector<std::size_t> held_out;  ///< inside the blocks: familiar places at unseen times
  std::vector<std::size_t> unknown;   ///< all samples of the unknown flights
};

/// A flight's duration runs from its first sample to its last, which belongs to a block that ends at 1.
/// @throws ConfigError if an unknown flight is not among the samples
SampleSplit choose(const std::vector<SampleTime>& samples, const SplitConfig& config);

/// What is wrong with a gap shorter than the time over which a depth map collects its points: samples on its two sides
/// share LiDAR points, and the held-out ones are no longer unseen. Empty if nothing is.
std::string leak_through_gap(const SplitConfig& config, double window_s);

}  // namespace alight
