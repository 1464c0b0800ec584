#pragma once

#include <string>

#include "train/evaluation/scores/evaluator.hpp"

namespace alight {

/// For readers: a table a region and metric, methods as rows, feedings as columns, each cell the mean over flights and
/// its standard error over flights. `*` marks cells in which the altitude plane stands in for a method.
std::string to_markdown(const EvaluationReport& report);

}  // namespace alight
