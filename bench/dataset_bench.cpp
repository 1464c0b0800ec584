// What building a data set costs beside the codecs of its images: run by scripts/bench/dataset.sh. Prints one JSON line.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "dataset/build/dataset_config.hpp"
#include "dataset/build/sample_writer.hpp"
#include "dataset/store/sample_store.hpp"
#include "foundation/command_line.hpp"
#include "foundation/errors.hpp"
#include "geometry/frames.hpp"
#include "geometry/rig/find_rig_file.hpp"
#include "sensors/bag/bag_messages.hpp"
#include "sensors/messages/decoders.hpp"
#include "sensors/stream/flight_log.hpp"

namespace {

namespace fs = std::filesystem;
using alight::BuiltSample;

double seconds_of(const std::function<void()>& body) {
  const auto begin = std::chrono::steady_clock::now();
  body();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Every sample of a log, as alight-dataset build makes it, handed to `take` instead of being encoded.
/// @param with_images false: depth maps alone
void build_samples(const alight::DatasetConfig& config, const alight::Rig& rig, const fs::path& log,
                   bool with_images, const std::function<void(BuiltSample)>& take) {
  alight::FlightLog messages(log, rig, config.log);
  messages.keep_every_nth_image(config.depth_map.every_nth_image);
  if (!with_images) messages.put_off_decoding();
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

/// The images of a log as they are in it, by topic and stamp.
class StoredImages {
 public:
  StoredImages(const fs::path& log, const alight::Rig& rig) {
    alight::BagMessages bag(log);
    std::set<std::string> topics;
    for (const alight::BagConnection& connection : bag.connections()) {
      for (const std::string& topic : {rig.cam0.topic, rig.cam1 ? rig.cam1->topic : std::string()}) {
        if (connection.topic != topic && connection.topic != topic + "/compressed") continue;
        topics.insert(connection.topic);
        decoder_ = alight::find_decoder(alight::LogRole::kImage, connection.type);
      }
    }
    bag.select(topics);
    while (const auto message = bag.next()) {
      const alight::RawMessage& raw = message->raw;
      const std::int64_t t_ns = std::get<alight::CameraImage>(*decoder_->decode(raw, {})).t_ns;
      images_[t_ns].emplace_back(raw.data, raw.data + raw.size);
    }
  }

  /// Decodes all images of one exposure.
  void decode(std::int64_t t_ns) const {
    for (const std::vector<std::uint8_t>& bytes : images_.at(t_ns))
      decoder_->decode({bytes.data(), bytes.size(), 0}, {});
  }

 private:
  const alight::Decoder* decoder_ = nullptr;
  std::map<std::int64_t, std::vector<std::vector<std::uint8_t>>> images_;
};

/// Decodes and encodes, with all cores, what a build decodes and encodes; all of it is in memory before. No builder can be
/// faster.
double codec_seconds(const alight::DatasetConfig& config, const alight::Rig& rig, const fs::path& log,
                     const std::vector<BuiltSample>& samples, const fs::path& dir) {
  const StoredImages images(log, rig);
  alight::FlightEntry flight;
  flight.name = "codec";
  flight.has_right = !samples.front().right.empty();
  alight::create_flight_folders(dir, flight);
  return seconds_of([&] {
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    alight::SampleWriter writer(cores, 8);
    for (std::size_t i = 0; i < samples.size(); ++i) {
      writer.add([&, i] {
        const BuiltSample& sample = samples[i];
        images.decode(sample.t_ns - alight::to_nanoseconds(rig.cam0.timeshift_cam_imu_s));
        alight::write_sample(dir, flight, static_cast<int>(i), {sample.left, sample.right, sample.sparse, {}},
                             config.png_compression);
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
    std::vector<BuiltSample> samples;
    build_samples(config, rig, log, true, [&](BuiltSample sample) { samples.push_back(std::move(sample)); });
    if (samples.empty()) throw alight::DataError(log + ": gives no sample");
    int maps = 0;
    const double maps_s =
        seconds_of([&] { build_samples(config, rig, log, false, [&](const BuiltSample&) { ++maps; }); });
    const double codec_s = codec_seconds(config, rig, log, samples, work);
    std::printf("{\"maps\": %d, \"maps_seconds\": %.4f, \"codec_seconds\": %.4f}\n", maps, maps_s, codec_s);
    return alight::kExitOk;
  });
}
