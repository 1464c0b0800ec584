#include "dataset/build/dataset_builder.hpp"

#include <algorithm>
#include <future>
#include <map>
#include <numeric>
#include <set>
#include <thread>

#include <opencv2/core/utility.hpp>

#include "dataset/store/dataset_folder.hpp"
#include "foundation/config_reader.hpp"
#include "foundation/content_hash.hpp"
#include "foundation/errors.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

void check_inputs(const Rig& rig, const std::vector<fs::path>& logs) {
  if (!rig.lidar0) throw ConfigError("rig: has no lidar0; a data set needs a LiDAR");
  if (!rig.cam0.T_camera_imu)
    throw ConfigError("rig: cam0 has no T_cam_imu; a data set needs the camera's mounting");
  if (logs.empty()) throw ConfigError("no log was named; give at least one --log FILE.bag");
  std::set<std::string> names;
  for (const fs::path& log : logs) {
    if (!names.insert(flight_name(log)).second) {
      throw ConfigError("two logs are named " + flight_name(log) +
                        "; a flight's folder is named after its log: rename one");
    }
  }
}

/// OpenCV computes on the calling thread alone. A process that forks while the threads of OpenCV's pool are busy hands its
/// child locks that nobody gives back (the allocator of AddressSanitizer hangs on them), and the builds share out the cores
/// themselves.
class SerialOpenCv {
 public:
  SerialOpenCv() { cv::setNumThreads(1); }
  ~SerialOpenCv() { cv::setNumThreads(before_); }
  SerialOpenCv(const SerialOpenCv&) = delete;
  SerialOpenCv& operator=(const SerialOpenCv&) = delete;

 private:
  int before_ = cv::getNumThreads();
};

int cores() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

/// One build: which logs have to be read, reading them, and putting the data set together.
class DatasetBuild {
 public:
  DatasetBuild(const DatasetConfig& config, const Rig& rig, const std::vector<fs::path>& logs,
               const fs::path& output, const BuildOptions& options)
      : config_(config),
        rig_(rig),
        logs_(logs),
        options_(options),
        recipe_(recipe_of(config, rig)),
        folder_(output) {
    result_.info.rig = DepthMapBuilder(rig, config.depth_map).rig();
    result_.info.window_before_s = config.depth_map.window_before_s;
    result_.info.window_after_s = config.depth_map.window_after_s;
    result_.info.accumulation_s = config.depth_map.window_before_s + config.depth_map.window_after_s;
    result_.info.config = print_config(config);
  }

  BuildResult run() {
    keep_others();
    for (const fs::path& log : logs_) keep_or_plan(log);
    build_planned();
    collect();
    folder_.commit(result_.info);
    return std::move(result_);
  }

 private:
  /// Flights of the data set whose logs were not named stay, if they were built alike.
  void keep_others() {
    for (const FlightEntry& flight : folder_.existing()) {
      const bool named = std::any_of(logs_.begin(), logs_.end(),
                                     [&](const fs::path& log) { return flight_name(log) == flight.name; });
      if (named) continue;
      const std::vector<FlightRecord> records = folder_.finished(flight.name);
      if (records.empty() || records.back().recipe != recipe_) {
        throw DataError(
            "the data set holds flight " + flight.name +
            ", which was built with another configuration, rig or version; name its log too, so that it is "
            "built again, or build into another folder");
      }
      finished_[flight.name] = flight;
    }
  }

  void keep_or_plan(const fs::path& log) {
    const std::string name = flight_name(log);
    std::error_code code;
    if (fs::exists(log, code)) {
      for (const FlightRecord& record : folder_.finished(name)) {
        if (!is_up_to_date(record, recipe_, log, !dense_folder_of(log).empty())) continue;
        finished_[name] = record.entry;
        result_.kept.push_back(name);
        return;
      }
    }
    folder_.discard(name);
    planned_.push_back(log);
  }

  void build_planned() {
    const int at_once = std::min(options_.at_once > 0 ? options_.at_once : cores(),
                                 std::max(1, static_cast<int>(planned_.size())));
    const int workers = std::max(1, cores() / at_once);
    std::vector<ChildBody> bodies;
    std::vector<std::int64_t> bytes;
    for (const fs::path& log : planned_) {
      bodies.push_back([this, log, workers](const std::function<void(double)>& progress) {
        build_one(log, workers, progress);
      });
      std::error_code code;
      const auto size = fs::file_size(log, code);
      bytes.push_back(code ? 0 : static_cast<std::int64_t>(size));
    }
    std::vector<double> shares(planned_.size(), 0);
    const std::int64_t total = std::accumulate(bytes.begin(), bytes.end(), std::int64_t{0});
    outcomes_ = run_in_children(bodies, at_once, config_.limits, [&](std::size_t index, double share) {
      shares[index] = share;
      if (options_.progress)
        options_.progress(std::llround(std::inner_product(shares.begin(), shares.end(), bytes.begin(), 0.0)),
                          total);
    });
  }

  /// In the child: the flight, then the record that says it is whole. The log is hashed meanwhile, which also reads it
  /// ahead.
  void build_one(const fs::path& log, int workers, const std::function<void(double)>& progress) const {
    LogIdentity identity = identify_log(log);
    std::future<std::string> hash = std::async(std::launch::async, content_hash_of_file, log);
    const FlightEntry entry = build_flight(config_, rig_, log, folder_.partial(), workers, progress);
    identity.hash = hash.get();
    write_flight_record(folder_.partial() / entry.name, {recipe_, identity, entry});
  }

  /// What the children left behind; the flights in the order in which they came to the data set.
  void collect() {
    bool bad_config = !outcomes_.empty();
    for (std::size_t i = 0; i < planned_.size(); ++i) {
      const std::string name = flight_name(planned_[i]);
      if (outcomes_[i].kind == ChildOutcome::Kind::kDone) {
        finished_[name] = folder_.finished(name).at(0).entry;
        result_.built.push_back(name);
      } else {
        folder_.discard(name);
        result_.failed.push_back(with_name(planned_[i], outcomes_[i].error));
      }
      bad_config &= outcomes_[i].kind == ChildOutcome::Kind::kBadConfig;
    }
    if (bad_config) throw ConfigError(result_.failed.front());
    if (finished_.empty()) throw DataError(result_.failed.front());
    for (const FlightEntry& flight : folder_.existing()) take(flight.name);
    for (const fs::path& log : logs_) take(flight_name(log));
  }

  void take(const std::string& flight) {
    const auto found = finished_.find(flight);
    if (found == finished_.end()) return;
    result_.info.flights.push_back(found->second);
    finished_.erase(found);
  }

  static std::string with_name(const fs::path& log, const std::string& error) {
    return error.find(log.string()) != std::string::npos ? error : log.string() + ": " + error;
  }

  const DatasetConfig& config_;
  const Rig& rig_;
  const std::vector<fs::path>& logs_;
  const BuildOptions& options_;
  const std::string recipe_;
  DatasetFolder folder_;
  std::map<std::string, FlightEntry> finished_;
  std::vector<fs::path> planned_;
  std::vector<ChildOutcome> outcomes_;
  BuildResult result_;
};

}  // namespace

BuildResult build_dataset(const DatasetConfig& config, const Rig& rig, const std::vector<fs::path>& logs,
                          const fs::path& output, const BuildOptions& options) {
  check_inputs(rig, logs);
  const SerialOpenCv serial;
  return DatasetBuild(config, rig, logs, output, options).run();
}

}  // namespace alight
