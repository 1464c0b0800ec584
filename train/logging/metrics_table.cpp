#include "train/logging/metrics_table.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "foundation/csv_line.hpp"
#include "foundation/errors.hpp"

namespace alight {
namespace {

std::vector<std::string> read_header(const std::string& line, const std::string& place) {
  std::vector<std::string> columns;
  std::istringstream cells(line);
  for (std::string name; std::getline(cells, name, ',');) {
    if (std::find(columns.begin(), columns.end(), name) != columns.end()) {
      throw DataError(place + ": column \"" + name + "\" is there twice; keep one of them");
    }
    columns.push_back(name);
  }
  if (std::find(columns.begin(), columns.end(), "epoch") == columns.end()) {
    throw DataError(place + ": no column \"epoch\"; is this the metrics.csv of alight-train?");
  }
  return columns;
}

void append_row(const std::string& line, const std::string& place, MetricsTable& table) {
  CsvLine cells(line, place);
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    table.values[i].push_back(cells.number_or_nan(table.columns[i].c_str()));
  }
  cells.expect_end();
}

}  // namespace

bool MetricsTable::has(const std::string& column) const {
  return std::find(columns.begin(), columns.end(), column) != columns.end();
}

const std::vector<double>& MetricsTable::at(const std::string& column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found == columns.end()) throw std::invalid_argument("MetricsTable: no column " + column);
  return values[static_cast<std::size_t>(found - columns.begin())];
}

MetricsTable read_metrics(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) {
    throw DataError(file.string() + ": not found or empty; name the folder of a run that finished an epoch");
  }
  MetricsTable table;
  table.columns = read_header(line, file.string() + ":1");
  table.values.resize(table.columns.size());
  for (int number = 2; std::getline(stream, line); ++number) {
    append_row(line, file.string() + ":" + std::to_string(number), table);
  }
  if (table.values.front().empty()) throw DataError(file.string() + ": no rows; the run finished no epoch");
  return table;
}

}  // namespace alight
