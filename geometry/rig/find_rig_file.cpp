#include "geometry/rig/find_rig_file.hpp"

#include <spdlog/spdlog.h>

#include "foundation/shipped_files.hpp"

namespace fs = std::filesystem;

namespace alight {

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

}  // namespace alight
