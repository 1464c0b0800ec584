#pragma once

#include <chrono>

namespace alight {

/// When something happened on this computer. Latencies are counted in it; no result depends on it.
using SteadyTime = std::chrono::steady_clock::time_point;

/// Now, on a clock that nobody sets.
inline SteadyTime steady_now() { return std::chrono::steady_clock::now(); }
/// From one time to another.
inline double milliseconds(SteadyTime from, SteadyTime to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

}  // namespace alight
