#include "dataset/build/flight_build.hpp"

#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include <opencv2/imgcodecs.hpp>
#include <spdlog/spdlog.h>

#include "dataset/build/sample_writer.hpp"
#include "foundation/errors.hpp"
#include "geometry/depth_map.hpp"
#include "geometry/frames.hpp"
#include "sensors/stream/flight_log.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kWaitingSamplesAWorker = 4;

/// Empty where there is none or it cannot be used.
fs::path usable_dense_folder(const fs::path& log, const DepthMapBuilder& builder) {
  fs::path folder = dense_folder_of(log);
  if (folder.empty() || builder.is_identity_rectification()) return folder;
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
  FlightBuild(const DatasetConfig& config, const Rig& rig, const fs::path& log, const fs::path& dir)
      : config_(config),
        rig_(rig),
        dir_(dir),
        path_(log),
        log_(log, rig, config.log),
        builder_(rig, config.depth_map) {
    log_.keep_every_nth_image(config.depth_map.every_nth_image);
    log_.put_off_decoding();  // the workers do it
    dense_folder_ = usable_dense_folder(log, builder_);
    flight_.name = flight_name(log);
    flight_.has_right = rig.cam1.has_value();
    flight_.has_dense = !dense_folder_.empty();
    create_flight_folders(dir_, flight_);
  }

  FlightEntry run(int workers, const std::function<void(double)>& progress) {
    SampleWriter writer(workers, kWaitingSamplesAWorker * static_cast<std::size_t>(workers));
    LogMessage message;
    while (log_.next(message)) {
      builder_.add(std::move(message));
      store_ready(writer);
      progress(static_cast<double>(log_.consumed()) / static_cast<double>(log_.summary().messages));
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
      writer.add([this, index, sample = std::make_shared<BuiltSample>(std::move(*built))] {
        store(index, *sample);
      });
    }
  }

  /// On a worker's thread.
  void store(int index, BuiltSample& built) {
    try {
      log_.decode(built.frame);
    } catch (const DecodeError& e) {
      const std::lock_guard<std::mutex> lock(mutex_);
      undecodable_.emplace(index, e.what());
      return;
    }
    builder_.add_images(built, built.frame);
    Sample sample{built.left, built.right, built.sparse, {}};
    const std::int64_t stamp_ns = built.t_ns - to_nanoseconds(rig_.cam0.timeshift_cam_imu_s);
    if (flight_.has_dense) sample.dense_m = read_dense(dense_folder_, stamp_ns, builder_.crop_rect());
    write_sample(dir_, flight_, index, sample, config_.png_compression);
  }

  /// The rows of samples whose images did not decode go, and the pictures of later ones move up.
  void drop_undecodable() {
    if (undecodable_.empty()) return;
    const auto& [first, reason] = *undecodable_.begin();
    const double after_s = to_seconds(rows_[static_cast<std::size_t>(first)].t_ns - rows_.front().t_ns);
    spdlog::warn(
        "{}: {} of {} images do not decode and are left out, the first {:.3f} s after the first sample: {}",
        path_.string(), undecodable_.size(), rows_.size(), after_s, reason);
    if (static_cast<double>(undecodable_.size()) >
        config_.log.max_bad_message_share * static_cast<double>(rows_.size())) {
      throw DataError(path_.string() + ": " + std::to_string(undecodable_.size()) + " of " +
                      std::to_string(rows_.size()) +
                      " images do not decode (log.max_bad_message_share allows " +
                      std::to_string(config_.log.max_bad_message_share) + "), the first: " + reason);
    }
    std::vector<SampleRow> kept;
    for (SampleRow row : rows_) {
      if (undecodable_.count(row.index) != 0) continue;
      const int index = static_cast<int>(kept.size());
      if (row.index != index) move_sample(dir_, flight_, row.index, index);
      row.index = index;
      kept.push_back(row);
    }
    rows_ = std::move(kept);
  }

  FlightEntry close() {
    drop_undecodable();
    FlightEntry entry = flight_;
    entry.samples = static_cast<int>(rows_.size());
    entry.dropped = log_.summary().dropped;
    for (const auto& [reason, count] : builder_.dropped()) entry.dropped[reason] += count;
    if (!undecodable_.empty())
      entry.dropped["images that do not decode"] = static_cast<std::int64_t>(undecodable_.size());
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
  std::mutex mutex_;
  std::map<int, std::string> undecodable_;  // samples whose images do not decode, and why; under mutex_
};

}  // namespace

std::string flight_name(const fs::path& log) { return log.stem().string(); }

fs::path dense_folder_of(const fs::path& log) {
  fs::path folder = log;
  folder.replace_extension(".truth");
  folder /= "depth";
  std::error_code code;
  return fs::is_directory(folder, code) ? folder : fs::path();
}

FlightEntry build_flight(const DatasetConfig& config, const Rig& rig, const fs::path& log,
                         const fs::path& dir, int workers, const std::function<void(double)>& progress) {
  return FlightBuild(config, rig, log, dir).run(workers, progress);
}

}  // namespace alight
