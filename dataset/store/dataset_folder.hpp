#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "dataset/store/flight_record.hpp"
#include "dataset/store/sample_store.hpp"
#include "foundation/errors.hpp"

namespace alight {

/// The folder of a data set while it is built. New flights grow in `<path>.partial/<flight>`; commit() puts them in place.
/// A new data set appears whole or not at all; one that is there already is added to. Finished flights of a build that
/// was killed are found again in `<path>.partial`.
class DatasetFolder {
 public:
  /// @throws DataError if `path` is there and no data set, or another process builds it at this moment
  explicit DatasetFolder(const std::filesystem::path& path);
  /// Removes `<path>.partial` unless a process was killed before.
  ~DatasetFolder();
  DatasetFolder(const DatasetFolder&) = delete;
  DatasetFolder& operator=(const DatasetFolder&) = delete;

  /// What the data set holds already; empty for a new one.
  const std::vector<FlightEntry>& existing() const { return existing_; }

  /// Records of a flight that is finished, in place or from a killed build.
  std::vector<FlightRecord> finished(const std::string& flight) const;

  /// Where new flights are built.
  const std::filesystem::path& partial() const { return partial_; }
  /// Removes what was begun of a flight.
  void discard(const std::string& flight);

  /// Moves what was built into place and writes dataset.yaml. @throws DataError
  void commit(const DatasetInfo& info);

 private:
  void lock();
  void replace(const std::string& flight);

  std::filesystem::path path_;
  std::filesystem::path partial_;
  std::vector<FlightEntry> existing_;
  bool is_new_ = true;
  int lock_ = -1;
};

}  // namespace alight
