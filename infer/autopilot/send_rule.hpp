#pragma once

#include "infer/depth/landing_pipeline.hpp"
#include "infer/onboard/mode_switch.hpp"

namespace alight {

/// The one rule by which a result may move the vehicle.
/// @param age_s how old the result's image is  @returns why it is not sent; null: it is
const char* reason_to_withhold(const FrameReport& frame, FlightMode mode, double age_s, double max_age_s);

}  // namespace alight
