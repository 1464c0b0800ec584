#include "dataset/commands.hpp"

#include <cstdio>
#include <memory>

#include "cli/progress_bar.hpp"
#include "dataset/dataset_builder.hpp"
#include "dataset/dataset_statistics.hpp"
#include "dataset/picture_file.hpp"
#include "dataset/sample_picture.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

/// One line a flight, below it what was left out of it.
void print_flights(const fs::path& dir, const DatasetInfo& info) {
  std::printf("%-24s %8s %10s %10s %10s %7s %6s\n", "flight", "samples", "duration_s", "points", "pixels",
              "stereo", "dense");
  for (const FlightEntry& flight : info.flights) {
    const std::vector<SampleRow> rows = read_samples(dir, flight.name);
    double points = 0;
    double pixels = 0;
    for (const SampleRow& row : rows) {
      points += row.points;
      pixels += row.pixels;
    }
    const double count = std::max<double>(1, static_cast<double>(rows.size()));
    const double duration_s = rows.empty() ? 0 : to_seconds(rows.back().t_ns - rows.front().t_ns);
    std::printf("%-24s %8zu %10.1f %10.0f %10.0f %7s %6s\n", flight.name.c_str(), rows.size(), duration_s,
                points / count, pixels / count, flight.has_right ? "yes" : "no",
                flight.has_dense ? "yes" : "no");
    for (const auto& [reason, dropped] : flight.dropped) {
      std::printf("  left out: %10lld %s\n", static_cast<long long>(dropped), reason.c_str());
    }
  }
  std::printf("points and pixels are means a sample\n");
}

/// One bar a log, made when the log's length is known.
class LogBars {
 public:
  void update(const fs::path& log, std::int64_t read, std::int64_t total) {
    if (log != log_) {
      bar_ = std::make_unique<ProgressBar>(log.filename().string(), total, "messages");
      log_ = log;
      read_ = 0;
    }
    bar_->advance(read - read_);
    read_ = read;
  }

 private:
  fs::path log_;
  std::int64_t read_ = 0;
  std::unique_ptr<ProgressBar> bar_;
};

const FlightEntry& find_flight(const DatasetInfo& info, const fs::path& dir, const std::string& name) {
  std::string known;
  for (const FlightEntry& flight : info.flights) {
    if (name.empty() || flight.name == name) return flight;
    known += (known.empty() ? "" : ", ") + flight.name;
  }
  throw DataError(dir.string() + ": has no flight \"" + name + "\"; it has " +
                  (known.empty() ? "none" : known));
}

}  // namespace

int run_build(const BuildOptions& options) {
  const auto config = load<DatasetConfig>(options.config);
  if (print_if_asked(options.config, config)) return kExitOk;
  if (options.output.empty()) throw ConfigError("--output is missing: name the folder to make");
  const Rig rig = load_rig(find_rig_file(config.rig, options.config.file));
  const std::vector<fs::path> logs(options.logs.begin(), options.logs.end());
  LogBars bars;
  const DatasetInfo info = build_dataset(
      config, rig, logs, options.output,
      [&bars](const fs::path& log, std::int64_t read, std::int64_t total) { bars.update(log, read, total); });
  print_flights(options.output, info);
  return kExitOk;
}

int run_info(const InfoOptions& options) {
  const fs::path dir = options.dataset;
  const DatasetInfo info = read_dataset_info(dir);
  const PinholeIntrinsics& k = info.rig.intrinsics;
  std::printf("format version   %d\n", info.format_version);
  std::printf("images           %dx%d pixels, f = %.2f %.2f px, c = %.2f %.2f px\n", k.width_px, k.height_px,
              k.fx_px, k.fy_px, k.cx_px, k.cy_px);
  std::printf("baseline         %.4f m\n", info.rig.baseline_m);
  std::printf("LiDAR window     %.2f s before .. %.2f s after the image\n\n", info.window_before_s,
              info.window_after_s);
  print_flights(dir, info);
  const DatasetStatistics statistics = measure_dataset(dir, info);
  std::printf("\n%s", format_statistics(statistics).c_str());
  if (!options.picture.empty()) {
    write_picture(options.picture, draw_statistics(statistics));
    std::printf("\n%s\n", options.picture.c_str());
  }
  return kExitOk;
}

int run_view(const ViewOptions& options) {
  const fs::path dir = options.dataset;
  const DatasetInfo info = read_dataset_info(dir);
  const FlightEntry& flight = find_flight(info, dir, options.flight);
  const std::vector<SampleRow> rows = read_samples(dir, flight.name);
  if (options.sample < 0 || options.sample >= static_cast<int>(rows.size())) {
    throw DataError(dir.string() + ": flight " + flight.name + " has samples 0 to " +
                    std::to_string(static_cast<long>(rows.size()) - 1) + ", not " +
                    std::to_string(options.sample));
  }
  const SampleRow& row = rows[static_cast<std::size_t>(options.sample)];
  const cv::Mat picture =
      draw_sample(read_sample(dir, flight, row, true), flight.name + " " + std::to_string(row.index));
  write_picture(options.output, picture);
  std::printf("%s\n", options.output.c_str());
  return kExitOk;
}

}  // namespace alight
