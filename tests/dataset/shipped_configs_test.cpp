#include <filesystem>

#include <gtest/gtest.h>

#include "dataset/build/dataset_builder.hpp"
#include "foundation/config_reader.hpp"
#include "geometry/rig/find_rig_file.hpp"

namespace alight {
namespace {

namespace fs = std::filesystem;

const fs::path kConfigs = fs::path(ALIGHT_SOURCE_DIR) / "configs" / "dataset";

TEST(ShippedDatasetConfigs, LoadWithTheRigThatTheyName) {
  int configurations = 0;
  for (const auto& entry : fs::directory_iterator(kConfigs)) {
    const auto config = load_config<DatasetConfig>(entry.path());
    const Rig rig = load_rig(find_rig_file(config.rig, entry.path()));
    EXPECT_NO_THROW(sensor_topics(rig, config.log)) << entry.path();
    EXPECT_NO_THROW(DepthMapBuilder(rig, config.depth_map)) << entry.path();
    ++configurations;
  }
  EXPECT_GE(configurations, 6);
}

}  // namespace
}  // namespace alight
