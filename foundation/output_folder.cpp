#include "foundation/output_folder.hpp"

#include <fstream>
#include <system_error>

#include "foundation/errors.hpp"

namespace alight {
namespace fs = std::filesystem;

OutputFolder::OutputFolder(const fs::path& path) : path_(path) {
  if (!path_.has_filename()) path_ = path_.parent_path();  // "out/" means "out"
  partial_ = path_;
  partial_ += ".partial";
  std::error_code code;
  if (fs::exists(path_, code) && !(fs::is_directory(path_, code) && fs::is_empty(path_, code))) {
    throw DataError(path_.string() +
                    ": exists already and is not overwritten; remove it or name another folder");
  }
  fs::remove_all(partial_, code);
  fs::create_directories(partial_, code);
  if (code) throw DataError(partial_.string() + ": cannot be created: " + code.message());
}

OutputFolder::~OutputFolder() {
  std::error_code code;
  if (!committed_) fs::remove_all(partial_, code);
}

void OutputFolder::commit() {
  std::error_code code;
  fs::remove(path_, code);  // an empty folder only; rename replaces nothing else
  fs::rename(partial_, path_, code);
  if (code)
    throw DataError(path_.string() + ": cannot be renamed from " + partial_.string() + ": " + code.message());
  committed_ = true;
}

void write_file_atomically(const fs::path& path, const std::string& content) {
  fs::path partial = path;
  partial += ".partial";
  {
    std::ofstream stream(partial, std::ios::binary);
    stream << content;
    stream.flush();
    if (!stream) {
      std::error_code ignored;
      fs::remove(partial, ignored);
      throw DataError(path.string() + ": cannot be written; check the folder, its rights and the free space");
    }
  }
  std::error_code code;
  fs::rename(partial, path, code);
  if (code) throw DataError(path.string() + ": cannot be written: " + code.message());
}

}  // namespace alight
