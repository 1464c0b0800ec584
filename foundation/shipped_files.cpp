#include "foundation/shipped_files.hpp"

#include <mutex>
#include <set>
#include <string>
#include <system_error>

#include <spdlog/spdlog.h>

#include "foundation/errors.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

bool may_be_shipped(const fs::path& name) {
  const fs::path normal = name.lexically_normal();
  if (normal.is_absolute() || normal.empty()) return false;
  return *normal.begin() == "configs" || *normal.begin() == "models";
}

/// A tool that asks for a file twice says so once.
void say_once(const std::string& message) {
  static std::mutex mutex;
  static std::set<std::string> said;
  const std::lock_guard<std::mutex> lock(mutex);
  if (said.insert(message).second) spdlog::info("{}", message);
}

}  // namespace

fs::path this_executable() {
  std::error_code code;
  return fs::read_symlink("/proc/self/exe", code);
}

std::optional<fs::path> shipped_folder(const fs::path& executable) {
  for (const char* from_program : {ALIGHT_DATA_FROM_BIN, "../share/alight"}) {
    std::error_code code;
    const fs::path folder = fs::canonical(executable.parent_path() / from_program, code);
    if (!code && fs::is_directory(folder / "configs", code)) return folder;
  }
  return std::nullopt;
}

std::optional<fs::path> shipped_file(const fs::path& name) {
  const std::optional<fs::path> folder = shipped_folder(this_executable());
  std::error_code code;
  if (!folder || !fs::is_regular_file(*folder / name, code)) return std::nullopt;
  return fs::canonical(*folder / name);
}

fs::path input_file(const fs::path& named) {
  std::error_code code;
  if (!may_be_shipped(named) || fs::exists(named, code)) return named;
  const std::string here = fs::current_path(code).string();
  if (const auto file = shipped_file(named)) {
    say_once(named.string() + ": not in " + here + "; taking the one that comes with the program, " +
             file->string());
    return *file;
  }
  const std::optional<fs::path> folder = shipped_folder(this_executable());
  throw ConfigError(named.string() + ": is not in " + here +
                    (folder ? ", and not among the files that come with the program, in " + folder->string()
                            : ", and no files came with this program") +
                    "; check the path");
}

}  // namespace alight
