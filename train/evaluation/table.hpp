#pragma once

#include <filesystem>
#include <string>

#include "train/evaluation/scores/evaluator.hpp"

namespace alight {

/// A line a method, feeding, region and metric: pooled value, mean over flights, standard error, counts.
std::string to_csv(const EvaluationReport& report);
/// Everything, with the values of every flight.
std::string to_json(const EvaluationReport& report);

/// Before the work begins. @throws ConfigError for another extension than .md, .csv or .json, DataError if the folder
/// is not there
void check_table_path(const std::filesystem::path& path);
/// In the format that the extension says. @throws as check_table_path, DataError if it cannot be written
void write_table(const EvaluationReport& report, const std::filesystem::path& path);

}  // namespace alight
