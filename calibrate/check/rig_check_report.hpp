#pragma once

#include <string>

#include <opencv2/core.hpp>

#include "calibrate/check/rig_check.hpp"

namespace alight {

/// The result for a reader, and as JSON.
std::string format_rig_check(const RigCheck& check);
std::string rig_check_json(const RigCheck& check);

/// The view with most depth edges: where the rig puts them (red) and where they would agree best (green), beside the
/// agreement over turns about x and y. CV_8UC3
cv::Mat draw_rig_check(const FlightViews& flight, const RigCheck& check, const RigCheckConfig& config);

}  // namespace alight
