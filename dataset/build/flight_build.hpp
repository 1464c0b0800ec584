#pragma once

#include <filesystem>
#include <functional>

#include "dataset/build/dataset_config.hpp"
#include "dataset/store/sample_store.hpp"

namespace alight {

/// "a/b/flight_1.bag" -> "flight_1"
std::string flight_name(const std::filesystem::path& log);

/// The simulator's true depth beside a log, `<log without .bag>.truth/depth`; empty where there is none.
std::filesystem::path dense_folder_of(const std::filesystem::path& log);

/// Builds the samples of one log into `dir/<flight>`, in this process: one thread reads and projects, `workers` threads
/// encode. The same log and configuration give the same bytes.
/// @param progress called with the share of the log that was read, 0..1
/// @throws DataError (a log that cannot be read or gives no sample), ConfigError
FlightEntry build_flight(const DatasetConfig& config, const Rig& rig, const std::filesystem::path& log,
                         const std::filesystem::path& dir, int workers,
                         const std::function<void(double)>& progress);

}  // namespace alight
