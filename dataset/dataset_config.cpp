#include "dataset/dataset_config.hpp"

#include <spdlog/spdlog.h>

#include "cli/shipped_files.hpp"
#include "configs/config_reader.hpp"
#include "dataset/content_hash.hpp"
#include "dataset/sample_store.hpp"

namespace alight {
namespace fs = std::filesystem;

void bind(Binder& b, DatasetConfig& c) {
  b.field("rig", c.rig, "rig file: sensors, their mounting and topics");
  b.section("log", c.log, "reading the logs");
  b.section("depth_map", c.depth_map, "from images and points to sparse depth maps");
  b.field("max_neighbour_gap_s", c.max_neighbour_gap_s,
          "samples farther apart are not previous and next of each other", positive());
  b.field("png_compression", c.png_compression, "0 none .. 9 smallest and slow", between(0, 9));
  b.section("limits", c.limits, "each log is read by a process of its own; when that is given up");
}

fs::path find_rig_file(const std::string& rig, const fs::path& config_file) {
  std::error_code code;
  const bool here = fs::path(rig).is_absolute() || fs::exists(rig, code);
  if (here || !fs::is_regular_file(config_file, code)) return input_file(rig);
  fs::path folder = fs::absolute(config_file, code).parent_path();
  while (!fs::exists(folder / rig, code)) {
    if (folder == folder.parent_path()) return input_file(rig);
    folder = folder.parent_path();
  }
  spdlog::info("{}: taking {}, by the configuration {}", rig, (folder / rig).string(), config_file.string());
  return folder / rig;
}

std::string recipe_of(const DatasetConfig& config, const Rig& rig) {
  DatasetConfig of_the_samples = config;
  of_the_samples.rig.clear();  // its content counts, not its name
  of_the_samples.png_compression = 0;
  of_the_samples.limits = {};
  return content_hash(std::to_string(kDatasetFormatVersion) + "\n" + print_config(of_the_samples) +
                      format_rig(rig));
}

}  // namespace alight
