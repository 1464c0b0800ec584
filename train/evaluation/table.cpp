#include "train/evaluation/table.hpp"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "foundation/errors.hpp"
#include "foundation/output_folder.hpp"
#include "train/evaluation/table_markdown.hpp"

namespace alight {
namespace {

using Json = nlohmann::ordered_json;

/// Six significant digits are finer than any of it is known.
std::string figure(double value) {
  if (std::isnan(value)) return "";
  return fmt::format("{:.6g}", value);
}

Json json_number(double value) { return std::isnan(value) ? Json(nullptr) : Json(std::stod(figure(value))); }

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

Json to_json(double pooled, const FlightMean& mean) {
  return {{"pooled", json_number(pooled)},
          {"mean", json_number(mean.mean)},
          {"standard_error", json_number(mean.standard_error)},
          {"flights", mean.flights}};
}

Json to_json(const PixelErrors& errors) {
  Json json;
  for (const Metric metric : kMetrics) json[name(metric)] = json_number(errors.value(metric));
  json["pixels"] = errors.pixels();
  json["substituted_pixels"] = errors.substituted();
  json["unknown_pixels"] = errors.unknown();
  return json;
}

Json to_json(const FlightErrors& errors) {
  const PixelErrors pooled = errors.pooled();
  Json json;
  for (const Metric metric : kMetrics) {
    json[name(metric)] = to_json(pooled.value(metric), errors.mean(metric));
  }
  json["pixels"] = pooled.pixels();
  json["substituted_pixels"] = pooled.substituted();
  json["unknown_pixels"] = pooled.unknown();
  for (const auto& [flight, part] : errors.flights()) json["by_flight"][flight] = to_json(part);
  return json;
}

void add_lines(std::string& text, const std::string& cell_name, const std::string& region,
               const FlightErrors& errors) {
  const PixelErrors pooled = errors.pooled();
  for (const Metric metric : kMetrics) {
    const FlightMean mean = errors.mean(metric);
    text += cell_name + region + "," + name(metric) + "," + figure(pooled.value(metric)) + "," +
            figure(mean.mean) + "," + figure(mean.standard_error) + "," + std::to_string(mean.flights) + "," +
            std::to_string(pooled.pixels()) + "," + std::to_string(pooled.substituted()) + "," +
            std::to_string(pooled.unknown()) + "\n";
  }
}

}  // namespace

std::string to_csv(const EvaluationReport& report) {
  std::string text =
      "method,feeding,region,metric,pooled,mean,standard_error,flights,pixels,substituted_pixels,unknown_"
      "pixels\n";
  for (std::size_t m = 0; m < report.methods.size(); ++m) {
    for (std::size_t f = 0; f < report.feedings.size(); ++f) {
      const EvaluationCell& cell = report.cells[m][f];
      const std::string cell_name = quoted(report.methods[m]) + "," + quoted(report.feedings[f].name()) + ",";
      for (const Region region : kRegions) {
        if (!cell.at(region).flights().empty()) add_lines(text, cell_name, name(region), cell.at(region));
      }
      if (cell.similarity.samples() == 0) continue;
      const FlightMean mean = cell.similarity.mean();
      text += cell_name + "right_image,ssim," + figure(cell.similarity.pooled()) + "," + figure(mean.mean) +
              "," + figure(mean.standard_error) + "," + std::to_string(mean.flights) + ",,,\n";
    }
  }
  return text;
}

std::string to_json(const EvaluationReport& report) {
  Json json;
  for (const auto& [key, value] : report.about) json["about"][key] = value;
  json["samples"] = report.first_method.size();
  for (const Region region : kRegions) json["regions"][name(region)] = describe(region, report.regions);
  json["results"] = Json::array();
  for (std::size_t m = 0; m < report.methods.size(); ++m) {
    for (std::size_t f = 0; f < report.feedings.size(); ++f) {
      const EvaluationCell& cell = report.cells[m][f];
      Json result{{"method", report.methods[m]}, {"feeding", report.feedings[f].name()}};
      for (const Region region : kRegions) {
        if (!cell.at(region).flights().empty()) result["regions"][name(region)] = to_json(cell.at(region));
      }
      if (cell.similarity.samples() > 0) {
        result["ssim"] = to_json(cell.similarity.pooled(), cell.similarity.mean());
      }
      json["results"].push_back(std::move(result));
    }
  }
  return json.dump(1) + "\n";
}

void check_table_path(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  if (extension != ".md" && extension != ".csv" && extension != ".json") {
    throw ConfigError(path.string() + ": is no table's name; end it in .md, .csv or .json");
  }
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::error_code code;
  if (!std::filesystem::is_directory(folder, code)) {
    throw DataError(path.string() + ": the folder " + folder.string() + " is not there; make it first");
  }
}

void write_table(const EvaluationReport& report, const std::filesystem::path& path) {
  check_table_path(path);
  const std::string extension = path.extension().string();
  write_file_atomically(path, extension == ".md"    ? to_markdown(report)
                              : extension == ".csv" ? to_csv(report)
                                                    : to_json(report));
}

}  // namespace alight
