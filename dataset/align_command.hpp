#pragma once

#include <string>

#include "calibrate/clocks/clock_alignment.hpp"
#include "foundation/command_line.hpp"

namespace alight {

/// Options of `alight-dataset align`; paths of files.
struct AlignOptions {
  ConfigOptions config;
  std::string log;
  std::string rig;
  std::string picture;
};

/// Exit code of `alight-dataset align` where an offset cannot be told, as that of `alight-calibrate check`.
constexpr int kExitOffsetNotTold = 4;

/// What was found, and the lines to put into the rig file: its time shifts with the offsets added.
std::string format_clock_alignment(const ClockAlignment& alignment, const Rig& rig);

/// Adds the subcommand's options.
CLI::App* add_align(CLI::App& app, AlignOptions& options);
/// `alight-dataset align`: the result goes to stdout. @returns the exit code. @throws ConfigError, DataError
int run_align(const AlignOptions& options);

}  // namespace alight
