#pragma once

#include <filesystem>
#include <string>

#include "tests/support/programs.hpp"

namespace alight::test {

using ToolRun = CommandRun;

/// Runs `build/bin/<command line>` in the source folder, as the README's examples are run.
ToolRun run_tool(const std::string& command_line);

/// A fresh folder of its own for the current test.
std::filesystem::path test_folder();

/// A folder with one short simulated flight (`quick.bag`, `quick.truth`), made once per process.
const std::filesystem::path& quick_flight();

/// The data set of that flight, made once per process.
const std::filesystem::path& quick_dataset();

}  // namespace alight::test
