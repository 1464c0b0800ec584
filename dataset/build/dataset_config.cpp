#include "dataset/build/dataset_config.hpp"

#include "dataset/store/sample_store.hpp"
#include "foundation/config_reader.hpp"
#include "foundation/content_hash.hpp"

namespace alight {
void bind(Binder& b, DatasetConfig& c) {
  b.field("rig", c.rig, "rig file: sensors, their mounting and topics");
  b.section("log", c.log, "reading the logs");
  b.section("depth_map", c.depth_map, "from images and points to sparse depth maps");
  b.field("max_neighbour_gap_s", c.max_neighbour_gap_s,
          "samples farther apart are not previous and next of each other", positive());
  b.field("png_compression", c.png_compression, "0 none .. 9 smallest and slow", between(0, 9));
  b.section("limits", c.limits, "each log is read by a process of its own; when that is given up");
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
