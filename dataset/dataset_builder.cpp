#include "dataset/dataset_builder.hpp"

#include <memory>
#include <numeric>
#include <set>
#include <utility>

#include <opencv2/imgcodecs.hpp>
#include <spdlog/spdlog.h>

#include "cli/output_folder.hpp"
#include "configs/errors.hpp"
#include "dataset/sample_writer.hpp"
#include "geometry/depth_map.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMaxSamplesInMemory = 8;

std::string flight_name(const fs::path& log) { return log.stem().string(); }

/// The simulator's true depth beside a log; empty where there is none or it cannot be used.
fs::path dense_folder(const fs::path& log, const DepthMapBuilder& builder) {
  fs::path folder = log;
  folder.replace_extension(".truth");
  folder /= "depth";
  std::error_code code;
  if (!fs::is_directory(folder, code)) return {};
  if (builder.is_identity_rectification()) return folder;
  spdlog::warn("{}: true depth is of the raw image and this rig's images are rectified; it is left out",
               folder.string());
  return {};
}

cv::Mat read_dense(const fs::path& folder, std::int64_t stamp_ns, const cv::Rect& crop) {
  const fs::path path = folder / (std::to_string(stamp_ns) + ".png");
  std::error_code code;
  if (!fs::is_regular_file(path, code)) {
    throw DataError(path.string() +
                    ": no true depth for an image of the log; simulate the flight again, or move " +
                    folder.parent_path().string() + " away");
  }
  const cv::Mat depth_16 = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
  if (depth_16.empty() || depth_16.type() != CV_16UC1)
    throw DataError(path.string() + ": is no whole 16-bit PNG");
  if (crop.br().x > depth_16.cols || crop.br().y > depth_16.rows) {
    throw DataError(path.string() + ": is smaller than the rig's image");
  }
  return decode_depth(depth_16(crop).clone());
}

void link_neighbours(std::vector<SampleRow>& rows, std::int64_t max_gap_ns) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    if (rows[i].t_ns - rows[i - 1].t_ns > max_gap_ns) continue;
    rows[i].previous = rows[i - 1].index;
    rows[i - 1].next = rows[i].index;
  }
}

std::string describe(const std::map<std::string, std::int64_t>& dropped) {
  std::string text;
  for (const auto& [reason, count] : dropped)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
  return text.empty() ? "nothing" : text;
}

/// One flight of a data set under construction.
class FlightBuild {
 public:
  FlightBuild(const DatasetConfig& config, const Rig& rig, const fs::path& log, const fs::path& dir,
              PointPose point_pose)
      : config_(config),
        rig_(rig),
        dir_(dir),
        path_(log),
        log_(log, rig, config.log),
        builder_(rig, config.depth_map, point_pose) {
    dense_folder_ = dense_folder(log, builder_);
    flight_.name = flight_name(log);
    flight_.has_right = rig.cam1.has_value();
    flight_.has_dense = !dense_folder_.empty();
    create_flight_folders(dir_, flight_);
  }

  FlightEntry run(const BuildProgress& progress) {
    SampleWriter writer(kMaxSamplesInMemory);
    LogMessage message;
    while (log_.next(message)) {
      builder_.add(std::move(message));
      store_ready(writer);
      if (progress) progress(path_, log_.consumed(), log_.summary().messages);
    }
    builder_.finish();
    store_ready(writer);
    writer.finish();
    return close();
  }

 private:
  void store_ready(SampleWriter& writer) {
    while (auto built = builder_.next()) {
      const int index = static_cast<int>(rows_.size());
      rows_.push_back({index, built->t_ns, built->T_world_camera, -1, -1, built->points,
                       built->sparse.count(), built->height_m});
      const std::int64_t stamp_ns = built->t_ns - to_nanoseconds(rig_.cam0.timeshift_cam_imu_s);
      auto sample = std::make_shared<Sample>(Sample{built->left, built->right, built->sparse, {}});
      writer.add([this, sample, index, stamp_ns] {
        if (flight_.has_dense) sample->dense_m = read_dense(dense_folder_, stamp_ns, builder_.crop_rect());
        write_sample(dir_, flight_, index, *sample, config_.png_compression);
      });
    }
  }

  FlightEntry close() {
    FlightEntry entry = flight_;
    entry.samples = static_cast<int>(rows_.size());
    entry.dropped = log_.summary().dropped;
    for (const auto& [reason, count] : builder_.dropped()) entry.dropped[reason] += count;
    if (rows_.empty()) {
      throw DataError(path_.string() + ": gives no sample; left out were " + describe(entry.dropped) +
                      "; check the topics, the clocks and max_pose_gap_s");
    }
    link_neighbours(rows_, to_nanoseconds(config_.max_neighbour_gap_s));
    write_samples(dir_, entry.name, rows_);
    return entry;
  }

  const DatasetConfig& config_;
  const Rig& rig_;
  const fs::path dir_;
  const fs::path path_;
  FlightLog log_;
  DepthMapBuilder builder_;
  fs::path dense_folder_;
  FlightEntry flight_;
  std::vector<SampleRow> rows_;
};

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

}  // namespace

void bind(Binder& b, DatasetConfig& c) {
  b.field("rig", c.rig, "rig file: sensors, their mounting and topics");
  b.section("log", c.log, "reading the logs");
  b.section("depth_map", c.depth_map, "from images and points to sparse depth maps");
  b.field("max_neighbour_gap_s", c.max_neighbour_gap_s,
          "samples farther apart are not previous and next of each other", positive());
  b.field("png_compression", c.png_compression, "0 none .. 9 smallest and slow", between(0, 9));
}

DatasetInfo build_dataset(const DatasetConfig& config, const Rig& rig, const std::vector<fs::path>& logs,
                          const fs::path& output, const BuildProgress& progress, PointPose point_pose) {
  check_inputs(rig, logs);
  OutputFolder folder(output);
  DatasetInfo info;
  info.rig = DepthMapBuilder(rig, config.depth_map).rig();
  info.window_before_s = config.depth_map.window_before_s;
  info.window_after_s = config.depth_map.window_after_s;
  info.accumulation_s = info.window_before_s + info.window_after_s;
  info.config = print_config(config);
  for (const fs::path& log : logs) {
    info.flights.push_back(FlightBuild(config, rig, log, folder.partial(), point_pose).run(progress));
  }
  write_dataset_info(folder.partial(), info);
  folder.commit();
  return info;
}

fs::path find_rig_file(const std::string& rig, const fs::path& config_file) {
  std::error_code code;
  if (fs::path(rig).is_absolute() || config_file.empty() || fs::exists(rig, code)) return rig;
  fs::path folder = fs::absolute(config_file, code).parent_path();
  while (true) {
    if (fs::exists(folder / rig, code)) return folder / rig;
    if (folder == folder.parent_path()) return rig;  // load_rig says that it is not there
    folder = folder.parent_path();
  }
}

}  // namespace alight
