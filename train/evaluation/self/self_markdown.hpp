#pragma once

#include <string>

#include "train/evaluation/self/self_report.hpp"

namespace alight {

/// For readers: what was judged and how, the criteria, the decisions, by altitude and by look.
std::string to_markdown(const SelfReport& report);

}  // namespace alight
