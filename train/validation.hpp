#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "foundation/binder_fwd.hpp"
#include "models/depth_completion_net.hpp"
#include "train/data/sample_source.hpp"
#include "train/error_meter.hpp"

namespace alight {

/// On what a network is judged while it learns.
struct ValidationConfig {
  std::vector<double> shares{0, 0.1, 0.3, 0.5, 1.0};  ///< P: shares of the points fed (METHOD, "Evaluation")
  std::vector<double> windows_s;                      ///< accumulation windows that begin with the image
  int samples = 24;                                   ///< after every epoch, evenly spread; 0: all
  int final_samples = 0;  ///< at the end of the run, with dense truth where there is any; 0: all
};
void bind(Binder& b, ValidationConfig& c);

/// The errors at one way of feeding points, or of the altitude plane.
struct ValidationRow {
  std::string name;  ///< "P=0.3", "0.1s" or "altitude plane"
  double share = 0;  ///< NaN for a window
  double window_s = 0;
  ErrorMeter ground_truth;  ///< all pixels of the full LiDAR window
  ErrorMeter held_out;      ///< those of them that were not fed
  ErrorMeter dense;         ///< every pixel with true depth; empty for real flights
};

/// A network's errors on the validation samples; metres.
struct ValidationReport {
  std::vector<ValidationRow> network;  ///< in the order of the shares, then of the windows
  std::vector<ValidationRow>
      fill;                      ///< the pyramid fill of the same points, nothing learned; no pixels at P=0
  ValidationRow altitude_plane;  ///< over the samples whose height is known
  std::size_t samples = 0;

  /// Geometric mean of the RMSE over the shares, which weighs metres without LiDAR and centimetres with it
  /// alike.
  double score_mm() const;
  /// The network's row of P nearest to `share`, and the fill's.
  const ValidationRow& at(double share) const;
  const ValidationRow& fill_at(double share) const;
  std::string table() const;
  /// One line: RMSE of every row.
  std::string summary() const;
};

/// `count` of `size` samples, evenly spread; 0: all.
std::vector<std::size_t> spread(std::size_t size, int count);

/// Predicts the samples with every share and window of their points. Which points are fed depends on `seed` and the
/// sample.
/// @param progress called after every sample
ValidationReport validate(DepthCompletionNet net, SampleSource& source,
                          const std::vector<std::size_t>& samples, const ValidationConfig& config,
                          std::uint64_t seed, const std::function<void()>& progress = {});

}  // namespace alight
