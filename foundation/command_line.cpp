#include "foundation/command_line.hpp"

#include <cstdlib>
#include <exception>
#include <limits>

#include <malloc.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

namespace alight {
namespace {

int fail(const std::exception& e, int code) {
  spdlog::default_logger()->flush();
  std::fprintf(stderr, "error: %s\n", e.what());
  return code;
}

/// Log lines go to stderr, so that stdout holds a tool's result alone.
void start_logging(bool quiet, bool verbose) {
  auto logger = spdlog::get("alight");
  if (!logger) logger = spdlog::stderr_color_mt("alight");
  logger->set_pattern("%^%l%$ %v");
  logger->set_level(quiet ? spdlog::level::warn : verbose ? spdlog::level::debug : spdlog::level::info);
  spdlog::set_default_logger(logger);
}

}  // namespace

int run_tool(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  bool quiet = false;
  bool verbose = false;
  app.add_flag("-q,--quiet", quiet, "Only warnings and errors");
  app.add_flag("-v,--verbose", verbose, "Debug messages too");
  app.set_version_flag("--version", std::string("alight ") + ALIGHT_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kExitOk : kExitUsage;
  }
  start_logging(quiet, verbose);
  try {
    return body();
  } catch (const ConfigError& e) {
    return fail(e, kExitUsage);
  } catch (const std::exception& e) {
    return fail(e, kExitFailure);
  }
}

void restart_with_short_spin(char** argv) {
  if (std::getenv("GOMP_SPINCOUNT") != nullptr || std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  setenv("GOMP_SPINCOUNT", "1000", 1);
  execv("/proc/self/exe", argv);  // returns only where it fails, and then the tool is merely slower
}

void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kTopPad_bytes = 64 << 20;
  mallopt(M_ARENA_MAX, 1);  // others give memory back whatever is said
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  mallopt(M_TOP_PAD, kTopPad_bytes);
#endif
}

void add_config_options(CLI::App& app, ConfigOptions& options, const std::string& default_file) {
  options.file = default_file;
  auto* file = app.add_option("-c,--config", options.file, "YAML configuration file");
  if (!default_file.empty()) file->capture_default_str();
  app.add_option("--set", options.overrides, "Override one key of the file: --set a.b=value (repeatable)")
      ->allow_extra_args(false);
  app.add_flag("--print-config", options.print,
               "Print the resolved configuration with a comment a key, then exit");
}

}  // namespace alight
