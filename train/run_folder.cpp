#include "train/run_folder.hpp"

#include <system_error>

#include "cli/output_folder.hpp"
#include "configs/errors.hpp"

namespace alight {
namespace fs = std::filesystem;

RunFolder::RunFolder(const fs::path& path) : path_(path) {
  std::error_code code;
  if (fs::exists(path_, code) && !(fs::is_directory(path_, code) && fs::is_empty(path_, code))) {
    throw DataError(path_.string() +
                    ": exists already and is not overwritten; remove it or name another folder");
  }
  fs::create_directories(path_, code);
  if (code) throw DataError(path_.string() + ": cannot be created: " + code.message());
}

void RunFolder::write(const std::string& name, const std::string& content) const {
  write_file_atomically(file(name), content);
}

void RunFolder::append_metrics(const std::vector<std::string>& cells) {
  if (!metrics_.is_open()) metrics_.open(file("metrics.csv"));
  for (std::size_t i = 0; i < cells.size(); ++i) metrics_ << (i == 0 ? "" : ",") << cells[i];
  metrics_ << '\n';
  metrics_.flush();
  if (!metrics_) throw DataError(file("metrics.csv").string() + ": cannot be written; check the free space");
}

}  // namespace alight
