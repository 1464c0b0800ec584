#pragma once

#include <opencv2/core.hpp>

#include "train/evaluation/self/self_report.hpp"

namespace alight {

/// ROC curves of the criteria and the decisions as dots, of the network's own maps and of all. CV_8UC3
/// @throws DataError where there are not both good maps and others
cv::Mat draw_roc(const SelfReport& report);

}  // namespace alight
