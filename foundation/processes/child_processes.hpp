#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "foundation/binder_fwd.hpp"

namespace alight {

// Work in processes of its own, in two ways. `run_in_children` forks: a body is a function of this program with all that
// it has in memory, is watched, and says how far it is. `run_programs` starts programs that share none of that memory,
// which is safe where this process has threads; what they come to is in their files.

/// When a child process is given up.
struct ChildLimits {
  double max_silence_s = 120;    ///< without progress
  double max_memory_mib = 2048;  ///< resident
};
void bind(Binder& b, ChildLimits& c);

/// What a child does; it reports its progress as a share of its work, 0..1, and throws where it fails.
using ChildBody = std::function<void(const std::function<void(double)>& progress)>;

/// How a child ended.
struct ChildOutcome {
  enum class Kind { kDone, kBadConfig, kFailed };
  Kind kind = Kind::kFailed;
  std::string error;  ///< empty if done
};

/// Runs every body in a process of its own, `at_once` of them at a time, so that one that crashes, hangs or wants too
/// much memory takes nothing else with it. What a body writes to files stays, what it writes to memory is lost.
/// @param progress called in this process with (index of the body, its share done); what it throws ends all children
/// @param now the clock that silence is measured by
std::vector<ChildOutcome> run_in_children(
    const std::vector<ChildBody>& bodies, int at_once, const ChildLimits& limits,
    const std::function<void(std::size_t, double)>& progress,
    const std::function<std::chrono::steady_clock::time_point()>& now = std::chrono::steady_clock::now);

/// Runs the program `command(i)`, its path and arguments, for each i below `count`, `at_once` of them at a time. One that
/// cannot be started is logged with its reason.
/// @param finished is told after every program that ended
/// @returns how many failed: did not start, did not end with exit code 0, or ended unseen because somebody else waited
/// for them
int run_programs(std::size_t count, int at_once,
                 const std::function<std::vector<std::string>(std::size_t)>& command,
                 const std::function<void()>& finished);

}  // namespace alight
