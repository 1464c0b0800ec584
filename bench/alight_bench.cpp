#include <benchmark/benchmark.h>

#include "foundation/command_line.hpp"

/// As the onboard program is, so that stages are timed as they run there.
int main(int argc, char** argv) {
  alight::keep_freed_memory();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
