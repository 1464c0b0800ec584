#include "train/logging/run_folder.hpp"

#include <cstdlib>
#include <optional>
#include <system_error>

#include "foundation/errors.hpp"
#include "foundation/file_content.hpp"
#include "foundation/output_folder.hpp"

namespace alight {
namespace fs = std::filesystem;

RunFolder::RunFolder(const fs::path& path, Open open) : path_(path) {
  std::error_code code;
  if (open == Open::kExisting) {
    if (has("config.yaml")) return;
    throw DataError(path_.string() +
                    ": is no training run (it has no config.yaml); name the folder of a run");
  }
  if (fs::exists(path_, code) && !(fs::is_directory(path_, code) && fs::is_empty(path_, code))) {
    throw DataError(
        path_.string() +
        ": exists already and is not overwritten; remove it, name another folder, or --resume it");
  }
  fs::create_directories(path_, code);
  if (code) throw DataError(path_.string() + ": cannot be created: " + code.message());
}

bool RunFolder::has(const std::string& name) const {
  std::error_code code;
  return fs::is_regular_file(file(name), code);
}

void RunFolder::write(const std::string& name, const std::string& content) const {
  write_file_atomically(file(name), content);
}

std::string RunFolder::read(const std::string& name) const {
  const std::optional<std::string> content = file_content(file(name));
  if (!content) throw DataError(file(name).string() + ": cannot be read");
  return *content;
}

void RunFolder::append_metrics(const std::vector<std::string>& cells) {
  if (!metrics_.is_open()) metrics_.open(file("metrics.csv"), std::ios::app);
  for (std::size_t i = 0; i < cells.size(); ++i) metrics_ << (i == 0 ? "" : ",") << cells[i];
  metrics_ << '\n';
  metrics_.flush();
  if (!metrics_) throw DataError(file("metrics.csv").string() + ": cannot be written; check the free space");
}

void RunFolder::keep_metrics(std::int64_t epochs) {
  std::ifstream stream(file("metrics.csv"));
  std::string head;
  std::string rows;
  std::getline(stream, head);
  for (std::string line; std::getline(stream, line);) {
    // A row that was cut off while it was written ends without a line break; its epoch is not finished either.
    if (std::strtoll(line.c_str(), nullptr, 10) <= epochs) rows += line + '\n';
  }
  if (metrics_.is_open()) metrics_.close();
  write("metrics.csv", epochs > 0 ? head + '\n' + rows : "");
}

}  // namespace alight
