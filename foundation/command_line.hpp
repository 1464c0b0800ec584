#pragma once

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "foundation/config_reader.hpp"
#include "foundation/shipped_files.hpp"

namespace alight {

/// Exit codes of every tool: 0 done, 1 the world failed (DataError and the rest), 2 usage or configuration.
enum ExitCode { kExitOk = 0, kExitFailure = 1, kExitUsage = 2 };

/// Parses argv with `app`, then runs `body`; turns exceptions into a message on stderr and an exit code.
/// Adds --version, --quiet and --verbose. `body` returns the exit code.
int run_tool(CLI::App& app, int argc, char** argv, const std::function<int()>& body);

/// For tools that compute with LibTorch; the first call of main. libgomp's threads spin while they wait for each other,
/// and where other programs want the same cores that slows a network by ten times and more; with a short spin they
/// sleep instead. libgomp reads the setting when it is loaded, so the tool starts itself anew, once, with it in the
/// environment. What the user set (GOMP_SPINCOUNT or OMP_WAIT_POLICY) stays.
void restart_with_short_spin(char** argv);

/// Freed memory stays with the process; the first call of main after restart_with_short_spin(). A training step, and a
/// frame on board, frees and takes the same megabytes again and again; handing them back to the system in between costs
/// a tenth of its time in page faults.
void keep_freed_memory();

/// The options through which every tool takes its YAML file.
struct ConfigOptions {
  std::string file;                    ///< empty: the built-in defaults
  std::vector<std::string> overrides;  ///< a.b=value
  bool print = false;
};

/// Adds --config, --set and --print-config. `default_file` may be empty.
void add_config_options(CLI::App& app, ConfigOptions& options, const std::string& default_file = "");

/// Loads the configuration (input_file), or binds the overrides to the defaults where no file was named.
template <class T>
T load(const ConfigOptions& options) {
  return options.file.empty() ? parse_config<T>("", "defaults", options.overrides)
                              : load_config<T>(input_file(options.file), options.overrides);
}

/// For --print-config: writes the resolved file to stdout. @returns true if the tool is done with that.
template <class T>
bool print_if_asked(const ConfigOptions& options, const T& config) {
  if (options.print) std::fputs(print_config(config).c_str(), stdout);
  return options.print;
}

}  // namespace alight
