// What building a data set costs beside the codecs of its images: run by scripts/bench_dataset.sh. Prints one JSON line.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>

#include "cli/command_line.hpp"
#include "configs/errors.hpp"
#include "dataset/dataset_config.hpp"
#include "dataset/flight_log.hpp"
#include "dataset/sample_store.hpp"
#include "dataset/sample_writer.hpp"

namespace {

namespace fs = std::filesystem;
using alight::BuiltSample;

double seconds_of(const std::function<void()>& body) {
  const auto begin = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Every sample of a log, as alight-dataset build makes it, handed to `take` instead of being encoded.
void build_samples(const alight::DatasetConfig& config, const alight::Rig& rig, const fs::path& log,
                   const std::function<void(BuiltSample)>& take) {
  alight::FlightLog messages(log, rig, config.log);
  alight::DepthMapBuilder builder(rig, config.depth_map);
  const auto take_ready = [&] {
    while (auto sample = builder.next()) take(std::move(*sample));
  };
  alight::LogMessage message;
  while (messages.next(message)) {
    builder.add(std::move(message));
    take_ready();
  }
  builder.finish();
  take_ready();
}

/// Encodes samples that are in memory with all cores: what no builder can be faster than.
double encode_seconds(const alight::DatasetConfig& config, const std::vector<alight::Sample>& samples,
                      const fs::path& dir) {
  alight::FlightEntry flight;
  flight.name = "codec";
  flight.has_right = !samples.front().right.empty();
  alight::create_flight_folders(dir, flight);
  return seconds_of([&] {
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    alight::SampleWriter writer(cores, 8);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      writer.add([&, i] {
        alight::write_sample(dir, flight, static_cast<int>(i), samples[i], config.png_compression);
      });
    }
    writer.finish();
  });
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Parts of alight-dataset build, one at a time", "alight-bench-dataset"};
  alight::ConfigOptions options;
  std::string log;
  std::string work;
  alight::add_config_options(app, options);
  app.add_option("-l,--log", log, "A ROS 1 bag")->required();
  app.add_option("-w,--work", work, "Folder for what is encoded")->required();
  app.footer("Examples:\n  alight-bench-dataset --log a.bag --work /tmp/bench");
  return alight::run_tool(app, argc, argv, [&] {
    const auto config = alight::load<alight::DatasetConfig>(options);
    const alight::Rig rig = alight::load_rig(alight::find_rig_file(config.rig, options.file));
    std::vector<alight::Sample> samples;
    build_samples(config, rig, log, [&](BuiltSample s) {
      samples.push_back({s.left, s.right, s.sparse, {}});
    });
    if (samples.empty()) throw alight::DataError(log + ": gives no sample");
    int maps = 0;
    const double maps_s =
        seconds_of([&] { build_samples(config, rig, log, [&](const BuiltSample&) { ++maps; }); });
    const double encode_s = encode_seconds(config, samples, work);
    std::printf("{\"maps\": %d, \"maps_seconds\": %.4f, \"encode_seconds\": %.4f}\n", maps, maps_s, encode_s);
    return alight::kExitOk;
  });
}
