#include "sim/record/bag_writer.hpp"

#include <system_error>

namespace alight::sim {
namespace fs = std::filesystem;

BagWriter::BagWriter(const fs::path& path, BagCompression compression) : path_(path), partial_(path) {
  partial_ += ".partial";
  std::error_code code;
  if (fs::exists(path_, code)) {
    throw DataError(path_.string() +
                    ": exists already and is not overwritten; remove it or name another folder");
  }
  fs::create_directories(path_.parent_path(), code);
  try {
    bag_.open(partial_.string(), rosbag::bagmode::Write);
  } catch (const rosbag::BagException& e) {
    throw DataError(path_.string() + ": cannot be created: " + e.what());
  }
  bag_.setCompression(compression == BagCompression::kLz4 ? rosbag::compression::LZ4
                                                          : rosbag::compression::Uncompressed);
}

BagWriter::~BagWriter() {
  if (committed_) return;
  try {
    bag_.close();
  } catch (const rosbag::BagException&) {
    // The file is about to be removed: what could not be written does not matter.
  }
  std::error_code code;
  fs::remove(partial_, code);
}

std::uintmax_t BagWriter::commit() {
  try {
    bag_.close();
  } catch (const rosbag::BagException& e) {
    throw DataError(path_.string() + ": cannot be written: " + e.what());
  }
  std::error_code code;
  fs::rename(partial_, path_, code);
  if (code)
    throw DataError(path_.string() + ": cannot be renamed from " + partial_.string() + ": " + code.message());
  committed_ = true;
  return fs::file_size(path_);
}

}  // namespace alight::sim
