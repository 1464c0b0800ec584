#pragma once

#include <opencv2/core.hpp>

#include "closed_loop/landing/landing_flight.hpp"

namespace alight::closed_loop {

/// The flight from the side and above, as the paper's figure draws it: the path by state, its shadow on the true ground,
/// axes in metres. @returns CV_8UC3
cv::Mat trajectory_picture(const FlownLanding& flown, const sim::SurfaceTruth& truth);

/// The place from above, north up: relief in grey, truly safe ground in green, fence, path by state, and where the vehicle
/// came down with the safe ground that it needs. @returns CV_8UC3
cv::Mat top_picture(const FlownLanding& flown, const sim::SurfaceTruth& truth, double body_radius_m);

}  // namespace alight::closed_loop
