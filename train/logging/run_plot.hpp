#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "foundation/errors.hpp"

namespace alight {

/// Colours that can be told apart in one figure.
constexpr std::size_t kMaxPlottedRuns = 10;

/// What is drawn of a run.
struct PlotOptions {
  int width_px = 1600;
  int chart_height_px = 360;
  bool overwrite = false;  ///< an existing file is replaced
};

/// Draws the metrics.csv of training runs over their epochs: the total loss, the learning rate where it is recorded,
/// and every rmse_mm_ column, each in a chart with all the runs that have it.
/// @param runs folders of runs, 1 to kMaxPlottedRuns; named in the legend by their last part where that tells them
/// apart @throws DataError naming the file: no or a damaged metrics.csv (`file:line`), runs without a column in common,
/// `png` exists or cannot be written. std::invalid_argument for another number of runs or a width below 400
void plot_runs(const std::vector<std::filesystem::path>& runs, const std::filesystem::path& png,
               const PlotOptions& options = {});

}  // namespace alight
