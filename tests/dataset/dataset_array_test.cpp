#include <fstream>

#include <gtest/gtest.h>

#include "dataset/build/dataset_builder.hpp"
#include "foundation/config_reader.hpp"
#include "tests/sensors/test_flight.hpp"
#include "tests/support/programs.hpp"

namespace alight::testing {
namespace {

namespace fs = std::filesystem;

/// The example script for clusters, with what Slurm sets in an array's tasks.
TEST(DatasetArray, ShardsOfAnArrayAndTheirMergeEqualOneBuild) {
  ScratchFolder folder;
  const fs::path dir = folder.path();
  DatasetConfig config;
  config.rig = (dir / "rig.yaml").string();
  config.depth_map.crop_px = 32;
  config.depth_map.every_nth_image = 1;
  write_bytes(config.rig, format_rig(small_rig()));
  write_bytes(dir / "config.yaml", print_config(config));
  std::string logs;
  std::vector<fs::path> paths;
  FlightOptions options;
  options.duration_s = 0.5;
  for (const char* name : {"a", "b", "c", "d", "e"}) {
    paths.push_back(dir / (std::string(name) + ".bag"));
    write_flight(paths.back(), options);
    logs += " " + paths.back().string();
  }
  const std::string program = "ALIGHT_DATASET=" ALIGHT_BINARY_DIR "/bin/alight-dataset ";
  const std::string script = ALIGHT_SOURCE_DIR "/scripts/cluster/dataset_array.sh ";
  const std::string output = (dir / "all").string();
  const auto task = [&](int index, int count) {
    return test::run_command("SLURM_ARRAY_TASK_ID=" + std::to_string(index) +
                             " SLURM_ARRAY_TASK_COUNT=" + std::to_string(count) + " " + program + script +
                             "build " + (dir / "config.yaml").string() + " " + output + logs)
        .exit_code;
  };
  EXPECT_EQ(task(1, 2), 0);
  EXPECT_EQ(task(2, 2), 0);
  EXPECT_EQ(task(7, 8), 0);  // more tasks than logs: nothing to do
  ASSERT_EQ(test::run_command(program + script + "merge " + output).exit_code, 0);

  std::map<std::string, int> merged;
  for (const FlightEntry& flight : read_dataset_info(output).flights) merged[flight.name] = flight.samples;
  const BuildResult once = build_dataset(load_config<DatasetConfig>(dir / "config.yaml"),
                                         load_rig(config.rig), paths, dir / "once");
  ASSERT_EQ(once.info.flights.size(), 5u);
  for (const FlightEntry& flight : once.info.flights) {
    EXPECT_EQ(merged[flight.name], flight.samples);
    EXPECT_EQ(read_tree(fs::path(output) / flight.name), read_tree(dir / "once" / flight.name));
  }
}

}  // namespace
}  // namespace alight::testing
