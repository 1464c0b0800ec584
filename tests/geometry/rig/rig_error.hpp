#pragma once

#include <string>

#include "foundation/errors.hpp"
#include "geometry/rig/rig.hpp"

namespace alight::testing {

/// What parse_rig complains of; empty: nothing.
inline std::string error_of(const std::string& text) {
  try {
    parse_rig(text, "rig.yaml");
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

}  // namespace alight::testing
