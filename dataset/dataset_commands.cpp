#include "dataset/dataset_commands.hpp"

#include <cstdio>
#include <memory>

#include "dataset/build/dataset_builder.hpp"
#include "dataset/build/dataset_merge.hpp"
#include "dataset/inspect/dataset_statistics.hpp"
#include "dataset/inspect/sample_picture.hpp"
#include "foundation/progress_bar.hpp"
#include "geometry/frames.hpp"
#include "geometry/rig/find_rig_file.hpp"
#include "pictures/picture_file.hpp"

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

/// "2/5": of five shards the second.
struct Shard {
  int index = 1;
  int count = 1;
};
Shard parse_shard(const std::string& text) {
  Shard shard;
  char rest = 0;
  const bool fits = std::sscanf(text.c_str(), "%d/%d%c", &shard.index, &shard.count, &rest) == 2;
  if (!fits || shard.index < 1 || shard.index > shard.count)
    throw ConfigError("--shard " + text + ": write i/N with 1 <= i <= N, such as 2/5");
  return shard;
}

std::vector<fs::path> logs_of(const BuildArguments& arguments) {
  const std::vector<fs::path> all(arguments.logs.begin(), arguments.logs.end());
  if (arguments.shard.empty()) return all;
  const Shard shard = parse_shard(arguments.shard);
  std::vector<fs::path> logs;
  for (std::size_t i = static_cast<std::size_t>(shard.index - 1); i < all.size();
       i += static_cast<std::size_t>(shard.count))
    logs.push_back(all[i]);
  if (logs.empty() && !all.empty())
    throw ConfigError("--shard " + arguments.shard + ": there are only " + std::to_string(all.size()) +
                      " logs");
  return logs;
}

/// In megabytes of logs; made when their size is known.
class BuildBar {
 public:
  void update(std::int64_t done_bytes, std::int64_t total_bytes) {
    if (!bar_) bar_ = std::make_unique<ProgressBar>("logs", total_bytes / kMegabyte, "MB");
    bar_->advance(done_bytes / kMegabyte - done_mb_);
    done_mb_ = done_bytes / kMegabyte;
  }
  void finish() { bar_.reset(); }

 private:
  static constexpr std::int64_t kMegabyte = 1'000'000;
  std::int64_t done_mb_ = 0;
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

int run_build(const BuildArguments& arguments) {
  const auto config = load<DatasetConfig>(arguments.config);
  if (print_if_asked(arguments.config, config)) return kExitOk;
  if (arguments.output.empty()) throw ConfigError("--output is missing: name the folder to make");
  const Rig rig = load_rig(find_rig_file(config.rig, arguments.config.file));
  BuildBar bar;
  BuildOptions options;
  options.at_once = arguments.jobs;
  options.progress = [&bar](std::int64_t done, std::int64_t total) { bar.update(done, total); };
  const BuildResult result = build_dataset(config, rig, logs_of(arguments), arguments.output, options);
  bar.finish();
  print_flights(arguments.output, result.info);
  if (!result.kept.empty())
    std::printf("%zu flights built, %zu up to date\n", result.built.size(), result.kept.size());
  for (const std::string& error : result.failed) std::fprintf(stderr, "alight-dataset: %s\n", error.c_str());
  if (result.failed.empty()) return kExitOk;
  std::fprintf(stderr, "alight-dataset: %zu of %zu logs are not in %s\n", result.failed.size(),
               result.failed.size() + result.built.size() + result.kept.size(), arguments.output.c_str());
  return kExitFailure;
}

int run_merge(const MergeArguments& arguments) {
  const std::vector<fs::path> parts(arguments.parts.begin(), arguments.parts.end());
  print_flights(arguments.output, merge_datasets(parts, arguments.output));
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
