#include "dataset/store/dataset_folder.hpp"

#include <chrono>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "foundation/errors.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

constexpr const char* kLockName = ".lock";
/// The children of a build that was killed share its lock until they are gone, too.
constexpr std::chrono::seconds kLockPatience{1};

void rename_or_throw(const fs::path& from, const fs::path& to) {
  std::error_code code;
  fs::rename(from, to, code);
  if (code)
    throw DataError(to.string() + ": cannot be renamed from " + from.string() + ": " + code.message());
}

}  // namespace

DatasetFolder::DatasetFolder(const fs::path& path) : path_(path) {
  if (!path_.has_filename()) path_ = path_.parent_path();  // "data/" means "data"
  partial_ = path_;
  partial_ += ".partial";
  std::error_code code;
  if (fs::exists(path_ / "dataset.yaml", code)) {
    existing_ = read_dataset_info(path_).flights;
    is_new_ = false;
  } else if (fs::exists(path_, code) && !(fs::is_directory(path_, code) && fs::is_empty(path_, code))) {
    throw DataError(
        path_.string() +
        ": exists already, is no data set and is not overwritten; remove it or name another folder");
  }
  fs::create_directories(partial_, code);
  if (code) throw DataError(partial_.string() + ": cannot be created: " + code.message());
  lock();
}

DatasetFolder::~DatasetFolder() {
  std::error_code code;
  fs::remove_all(partial_, code);
  close(lock_);
}

void DatasetFolder::lock() {
  lock_ = open((partial_ / kLockName).c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
  const auto give_up = std::chrono::steady_clock::now() + kLockPatience;
  while (lock_ >= 0) {
    if (flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
    if (std::chrono::steady_clock::now() > give_up) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  if (lock_ >= 0) close(lock_);
  throw DataError(path_.string() +
                  ": another alight-dataset builds it at this moment; wait for it, or stop it");
}

std::vector<FlightRecord> DatasetFolder::finished(const std::string& flight) const {
  std::vector<FlightRecord> records;
  for (const fs::path& dir : {partial_, path_}) {
    if (auto record = read_flight_record(dir / flight)) records.push_back(std::move(*record));
  }
  return records;
}

void DatasetFolder::discard(const std::string& flight) {
  std::error_code code;
  fs::remove_all(partial_ / flight, code);
}

void DatasetFolder::commit(const DatasetInfo& info) {
  std::error_code code;
  if (is_new_) {
    write_dataset_info(partial_, info);
    fs::remove(partial_ / kLockName, code);
    fs::remove(path_, code);  // an empty folder only; rename replaces nothing else
    rename_or_throw(partial_, path_);
    return;
  }
  for (const FlightEntry& flight : info.flights) {
    if (fs::exists(partial_ / flight.name, code)) replace(flight.name);
  }
  write_dataset_info(path_, info);
}

void DatasetFolder::replace(const std::string& flight) {
  std::error_code code;
  if (fs::exists(path_ / flight, code)) rename_or_throw(path_ / flight, partial_ / (flight + ".old"));
  rename_or_throw(partial_ / flight, path_ / flight);
}

}  // namespace alight
