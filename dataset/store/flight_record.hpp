#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "dataset/store/sample_store.hpp"
#include "foundation/errors.hpp"

namespace alight {

/// Which log a flight was built from.
struct LogIdentity {
  std::int64_t bytes = 0;
  std::int64_t modified_ns = 0;  ///< of the file, since the epoch
  std::string hash;              ///< content_hash_of_file; empty: not computed yet
};
/// Without the hash. @throws DataError if there is no such file
LogIdentity identify_log(const std::filesystem::path& log);

/// `<flight>/build.yaml`: what a finished flight was built from, so that it is not built a second time.
struct FlightRecord {
  std::string recipe;  ///< recipe_of
  LogIdentity log;
  FlightEntry entry;
};
void write_flight_record(const std::filesystem::path& flight_dir, const FlightRecord& record);
/// Empty if there is none or it cannot be read: then the flight is not finished.
std::optional<FlightRecord> read_flight_record(const std::filesystem::path& flight_dir);

/// True if building the flight again would change nothing: same recipe, same log (by size and time of the file, or by
/// content where the time differs), true depth there or not as before.
bool is_up_to_date(const FlightRecord& record, const std::string& recipe, const std::filesystem::path& log,
                   bool has_dense);

}  // namespace alight
