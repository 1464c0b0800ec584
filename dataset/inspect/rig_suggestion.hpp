#pragma once

#include <string>

#include "dataset/inspect/bag_inspection.hpp"

namespace alight {

/// "640x400 pixels, colour", "10000 points over 0.100 s, 12 dropped"
std::string describe(const DecodedMessage& message);

/// The lines of a rig file and of the section `log` that a bag suggests, FILL_IN where it cannot tell; empty if it holds
/// nothing that serves.
std::string suggest_configuration(const BagReport& report);

}  // namespace alight
