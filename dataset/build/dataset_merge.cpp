#include "dataset/build/dataset_merge.hpp"

#include <map>

#include "dataset/store/flight_record.hpp"
#include "foundation/errors.hpp"
#include "foundation/output_folder.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

void link_or_copy(const fs::path& from, const fs::path& to) {
  std::error_code code;
  fs::create_hard_link(from, to, code);
  if (code) fs::copy_file(from, to, code);
  if (code) throw DataError(to.string() + ": cannot be written: " + code.message());
}

void link_flight(const fs::path& from, const fs::path& to) {
  fs::create_directories(to);
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(from)) {
    const fs::path target = to / entry.path().lexically_relative(from);
    if (entry.is_directory()) {
      fs::create_directories(target);
    } else {
      link_or_copy(entry.path(), target);
    }
  }
}

/// What a flight was built with. @throws DataError if its data set does not say
std::string recipe_of_flight(const fs::path& part, const FlightEntry& flight) {
  const auto record = read_flight_record(part / flight.name);
  if (record) return record->recipe;
  throw DataError((part / flight.name).string() +
                  ": has no build.yaml that says what it was built with; build it again");
}

/// The flights of all parts, and what they have in common.
class Merge {
 public:
  void add(const fs::path& part) {
    const DatasetInfo info = read_dataset_info(part);
    if (first_.empty()) {
      first_ = part;
      info_ = info;
      info_.flights.clear();
    }
    for (const FlightEntry& flight : info.flights) {
      const auto [place, is_new] = part_of_.emplace(flight.name, part);
      if (!is_new)
        throw DataError(part.string() + ": holds flight " + flight.name + ", as does " +
                        place->second.string());
      require_recipe(part, recipe_of_flight(part, flight));
      info_.flights.push_back(flight);
    }
  }

  DatasetInfo write(const fs::path& output) const {
    OutputFolder folder(output);
    for (const FlightEntry& flight : info_.flights)
      link_flight(part_of_.at(flight.name) / flight.name, folder.partial() / flight.name);
    write_dataset_info(folder.partial(), info_);
    folder.commit();
    return info_;
  }

 private:
  void require_recipe(const fs::path& part, const std::string& recipe) {
    if (recipe_.empty()) recipe_ = recipe;
    if (recipe != recipe_) {
      throw DataError(part.string() + ": was built with another configuration, rig or version than " +
                      first_.string() + "; build both with the same");
    }
  }

  std::string recipe_;
  fs::path first_;
  DatasetInfo info_;
  std::map<std::string, fs::path> part_of_;
};

}  // namespace

DatasetInfo merge_datasets(const std::vector<fs::path>& parts, const fs::path& output) {
  Merge merge;
  for (const fs::path& part : parts) merge.add(part);
  return merge.write(output);
}

}  // namespace alight
