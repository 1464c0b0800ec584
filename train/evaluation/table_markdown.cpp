#include "train/evaluation/table_markdown.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

namespace alight {
namespace {

/// What a cell of a table shows.
struct CellText {
  FlightMean mean;
  bool substituted = false;
};
using CellOf = std::function<CellText(const EvaluationCell&)>;

std::string to_text(const CellText& cell, int digits) {
  if (std::isnan(cell.mean.mean)) return "-";
  std::string text = fmt::format("{:.{}f}", cell.mean.mean, digits);
  if (!std::isnan(cell.mean.standard_error))
    text += fmt::format(" ± {:.{}f}", cell.mean.standard_error, digits);
  return text + (cell.substituted ? " *" : "");
}

std::string grid(const EvaluationReport& report, const std::string& corner, int digits, bool shares_only,
                 const CellOf& cell_of) {
  std::vector<std::size_t> columns;
  for (std::size_t f = 0; f < report.feedings.size(); ++f) {
    if (!shares_only || report.feedings[f].kind == Feeding::Kind::kShare) columns.push_back(f);
  }
  std::string head = "| " + corner + " |";
  std::string rule = "|---|";
  for (const std::size_t f : columns) {
    head += " " + report.feedings[f].name() + " |";
    rule += "---:|";
  }
  std::string text = head + "\n" + rule + "\n";
  for (std::size_t m = 0; m < report.methods.size(); ++m) {
    text += "| " + report.methods[m] + " |";
    for (const std::size_t f : columns) text += " " + to_text(cell_of(report.cells[m][f]), digits) + " |";
    text += "\n";
  }
  return text + "\n";
}

bool has(const EvaluationReport& report, Region region) {
  const auto there = [&](const EvaluationCell& cell) { return !cell.at(region).flights().empty(); };
  return std::any_of(report.cells.begin(), report.cells.end(), [&](const std::vector<EvaluationCell>& row) {
    return std::any_of(row.begin(), row.end(), there);
  });
}

/// The parts of an image get the paper's two metrics, the whole image all four.
std::vector<Metric> metrics_of(Region region) {
  if (region == Region::kAll || region == Region::kHeldOut || region == Region::kDense) {
    return {kMetrics.begin(), kMetrics.end()};
  }
  return {Metric::kRmse, Metric::kRel};
}

std::string region_text(const EvaluationReport& report, Region region) {
  std::string text = "## " + std::string(name(region)) + "\n\n" + describe(region, report.regions) + ".\n\n";
  for (const Metric metric : metrics_of(region)) {
    text +=
        grid(report, title(metric), metric == Metric::kDelta ? 2 : 1, false, [&](const EvaluationCell& cell) {
          const FlightErrors& errors = cell.at(region);
          return CellText{errors.mean(metric), errors.pooled().substituted() > 0};
        });
  }
  return text;
}

bool has_similarity(const EvaluationReport& report) {
  return !report.cells.empty() &&
         std::any_of(report.cells[0].begin(), report.cells[0].end(),
                     [](const EvaluationCell& c) { return c.similarity.samples() > 0; });
}

}  // namespace

std::string to_markdown(const EvaluationReport& report) {
  std::string text = "# Depth completion: evaluation\n\n";
  for (const auto& [key, value] : report.about) text += "- " + key + ": " + value + "\n";
  text +=
      "- samples: " + std::to_string(report.first_method.size()) +
      "\n\nColumns: P, a random share of the full window's points, and seconds, the points that came in that "
      "time after the image. Cells: mean over flights ± its standard error over flights. `*`: the altitude "
      "plane stands in for pixels that the method left unknown. Values pooled over all pixels, pixel counts "
      "and every flight by itself: .csv and .json.\n\n";
  for (const Region region : kRegions) {
    if (has(report, region)) text += region_text(report, region);
  }
  if (has_similarity(report)) {
    text +=
        "## right image\n\nMean over the samples of the structural similarity between the right image and "
        "its "
        "reconstruction from the left one with the completed depth, over the pixels that both cameras "
        "see.\n\n" +
        grid(report, "SSIM", 4, true, [](const EvaluationCell& cell) {
          return CellText{cell.similarity.mean(), cell.at(Region::kAll).pooled().substituted() > 0};
        });
  }
  text.pop_back();
  return text;
}

}  // namespace alight
