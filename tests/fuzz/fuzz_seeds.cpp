// Writes what the fuzzers start from: real messages of each type, and small bags.
//   fuzz_seeds OUTPUT [BAG...]     OUTPUT/<type>/ from the bags and a simulated flight, OUTPUT/bag/
#include <cstdio>
#include <filesystem>
#include <map>

#include <rosbag/view.h>
#include <spdlog/spdlog.h>

#include "foundation/errors.hpp"
#include "sensors/bag/bag_messages.hpp"
#include "sensors/messages/decoders.hpp"
#include "tests/sensors/test_flight.hpp"
#include "tests/support/file_text.hpp"

namespace {

namespace fs = std::filesystem;
using namespace alight;

constexpr int kSeedsATopic = 10;
constexpr std::size_t kMaxSeedBytes = 100'000;

std::string folder_of(std::string type) {
  for (char& c : type) {
    if (c == '/') c = '_';
  }
  return type;
}

bool has_decoder(const std::string& type) {
  for (const Decoder& decoder : decoders()) {
    if (decoder.type == type) return true;
  }
  return false;
}

void write_messages(const fs::path& bag_path, const fs::path& output) {
  BagMessages bag(bag_path);
  std::map<std::string, int> written;
  while (const auto message = bag.next()) {
    const auto& [topic, type, md5, definition] = *message->connection;
    const RawMessage& raw = message->raw;
    if (!has_decoder(type) || raw.size > kMaxSeedBytes || written[topic]++ >= kSeedsATopic) continue;
    const fs::path folder = output / folder_of(type);
    fs::create_directories(folder);
    testing::write_bytes(
        folder / (bag_path.stem().string() + folder_of(topic) + std::to_string(written[topic])),
        std::string(reinterpret_cast<const char*>(raw.data), raw.size));
  }
}

/// The same small flight in every form of bag.
void write_bags(const fs::path& output) {
  fs::create_directories(output);
  testing::FlightOptions options;
  options.duration_s = 0.2;
  options.compressed = true;
  const fs::path plain = output / "plain.bag";
  testing::write_flight(plain, options);
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const rosbag::Bag in(plain.string(), rosbag::bagmode::Read);
    rosbag::Bag out((output / (std::to_string(compression) + ".bag")).string(), rosbag::bagmode::Write);
    out.setCompression(compression);
    rosbag::View view(in);
    for (const rosbag::MessageInstance& message : view)
      out.write(message.getTopic(), message.getTime(), message);
  }
  std::string killed = test::file_text(plain);
  killed.replace(killed.find("index_pos=") + 10, 8, std::string(8, '\0'));
  testing::write_bytes(output / "killed.bag", killed);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: fuzz_seeds OUTPUT [BAG...]\n");
    return 2;
  }
  spdlog::set_level(spdlog::level::off);
  const fs::path output = argv[1];
  write_bags(output / "bag");
  write_messages(output / "bag" / "plain.bag", output);
  for (int i = 2; i < argc; ++i) {
    try {
      write_messages(argv[i], output);
    } catch (const DataError& e) {
      std::fprintf(stderr, "fuzz_seeds: left out: %s\n", e.what());
    }
  }
  return 0;
}
