#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace alight::closed_loop {

/// What alight-sim can do: its options, and what runs when it was asked for. `run` returns the exit code.
struct Command {
  CLI::App* app;
  std::function<int()> run;
};

}  // namespace alight::closed_loop
