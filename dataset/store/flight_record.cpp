#include "dataset/store/flight_record.hpp"

#include <sys/stat.h>

#include "dataset/store/flight_section.hpp"
#include "foundation/config_reader.hpp"
#include "foundation/content_hash.hpp"
#include "foundation/errors.hpp"
#include "foundation/output_folder.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace fs = std::filesystem;

static void bind(Binder& b, LogIdentity& c) {
  b.required("bytes", c.bytes, "size of the log", at_least(0));
  b.required("modified_ns", c.modified_ns, "when the log was written last, since the epoch");
  b.required("hash", c.hash, "XXH3-128 of its content");
}

namespace {

constexpr const char* kFileName = "build.yaml";

struct RecordFile {
  std::string recipe;
  LogIdentity log;
  FlightSection flight;
};
void bind(Binder& b, RecordFile& c) {
  b.required("recipe", c.recipe, "hash of configuration, rig and format version");
  b.section("log", c.log, "what the flight was built from");
  b.section("flight", c.flight, "what came out");
}

}  // namespace

LogIdentity identify_log(const fs::path& log) {
  struct stat status{};
  if (stat(log.c_str(), &status) != 0)
    throw DataError(log.string() + ": no such file; check the path of the log");
  return {status.st_size, status.st_mtim.tv_sec * kNanosecondsPerSecond + status.st_mtim.tv_nsec, {}};
}

void write_flight_record(const fs::path& flight_dir, const FlightRecord& record) {
  write_file_atomically(flight_dir / kFileName,
                        print_config(RecordFile{record.recipe, record.log, to_section(record.entry)}));
}

std::optional<FlightRecord> read_flight_record(const fs::path& flight_dir) {
  std::error_code code;
  if (!fs::is_regular_file(flight_dir / kFileName, code)) return std::nullopt;
  try {
    const auto file = load_config<RecordFile>(flight_dir / kFileName);
    return FlightRecord{file.recipe, file.log, from_section(file.flight)};
  } catch (const ConfigError&) {
    return std::nullopt;
  }
}

bool is_up_to_date(const FlightRecord& record, const std::string& recipe, const fs::path& log,
                   bool has_dense) {
  if (record.recipe != recipe || record.entry.has_dense != has_dense) return false;
  const LogIdentity now = identify_log(log);
  if (now.bytes != record.log.bytes) return false;
  return now.modified_ns == record.log.modified_ns || content_hash_of_file(log) == record.log.hash;
}

}  // namespace alight
