#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "foundation/errors.hpp"

namespace alight {

/// A run's metrics.csv: one row an epoch, all numbers.
struct MetricsTable {
  std::vector<std::string> columns;  ///< names, left to right
  std::vector<std::vector<double>>
      values;  ///< one vector a column, all of the same length; NaN where it says nan

  bool has(const std::string& column) const;
  /// @throws std::invalid_argument if there is no such column
  const std::vector<double>& at(const std::string& column) const;
};

/// @throws DataError naming file and line: not there, no `epoch` column, a column twice, no rows, a row of another
/// length, a cell that is no number
MetricsTable read_metrics(const std::filesystem::path& file);

}  // namespace alight
