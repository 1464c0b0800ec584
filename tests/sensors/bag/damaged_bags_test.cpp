#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

#include <spdlog/spdlog.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dataset/build/dataset_builder.hpp"
#include "tests/sensors/test_flight.hpp"
#include "tests/support/file_text.hpp"

namespace alight::testing {
namespace {

namespace fs = std::filesystem;

/// How many bags are damaged: a part of them here, all of them in scripts/ci/fuzz.sh.
int number_of_bags() {
  const char* wanted = std::getenv("ALIGHT_DAMAGED_BAGS");
  return wanted != nullptr ? std::atoi(wanted) : 300;
}

using Random = std::mt19937;

std::size_t place(Random& random, std::size_t size) {
  return std::uniform_int_distribution<std::size_t>(0, size - 1)(random);
}

void flip_bytes(std::string& bytes, Random& random) {
  for (std::size_t i = 0; i < 1 + random() % 20; ++i)
    bytes[place(random, bytes.size())] = static_cast<char>(random() % 256);
}
/// The index and the connections lie at the end: lengths side by side.
void flip_tail(std::string& bytes, Random& random) {
  for (std::size_t i = 0; i < 1 + random() % 5; ++i)
    bytes[bytes.size() - 1 - place(random, std::min<std::size_t>(bytes.size(), 5000))] =
        static_cast<char>(random() % 256);
}
void cut_off(std::string& bytes, Random& random) { bytes.resize(1 + place(random, bytes.size())); }
void zero_a_block(std::string& bytes, Random& random) {
  const std::size_t at = place(random, bytes.size());
  bytes.replace(at, std::min<std::size_t>(4096, bytes.size() - at),
                std::string(std::min<std::size_t>(4096, bytes.size() - at), '\0'));
}
void lose_a_block(std::string& bytes, Random& random) {
  bytes.erase(place(random, bytes.size()), 1 + random() % 4096);
}
void double_a_block(std::string& bytes, Random& random) {
  const std::size_t at = place(random, bytes.size());
  bytes.insert(at, bytes.substr(at, 1 + random() % 4096));
}
/// Where a length or an offset may stand, one that is far too large.
void huge_number(std::string& bytes, Random& random) {
  const std::uint32_t values[] = {0xffffffffU, 0x7fffffffU, 0x80000000U, 0x10000000U, 0};
  if (bytes.size() < 4) return;
  std::memcpy(bytes.data() + place(random, bytes.size() - 3), &values[random() % 5], 4);
}
void forget_the_index(std::string& bytes, Random& random) {
  const std::size_t field = bytes.find("index_pos=");
  if (field == std::string::npos) return;
  bytes.replace(field + 10, 8, std::string(8, '\0'));
  flip_bytes(bytes, random);
}

using Damage = void (*)(std::string&, Random&);
constexpr Damage kDamages[] = {flip_bytes,   flip_tail,      cut_off,     zero_a_block,
                               lose_a_block, double_a_block, huge_number, forget_the_index};

/// Builds of damaged logs, each beside a whole one: the parent lives, nothing hangs, the whole log's flight is always
/// there, and a damaged one is either named as unusable, or has every sample, or says what was left out of it.
TEST(DamagedBags, BecomeErrorsOrSayWhatTheyLost) {
  spdlog::set_level(spdlog::level::off);
  ScratchFolder folder;
  FlightOptions options;
  options.duration_s = 0.5;
  const fs::path whole = folder.path() / "whole.bag";
  write_flight(whole, options);
  options.compressed = true;
  write_flight(folder.path() / "jpeg.bag", options);
  const std::vector<std::string> origins = {test::file_text(whole),
                                            test::file_text(folder.path() / "jpeg.bag")};

  DatasetConfig config;
  config.depth_map.crop_px = 32;
  config.depth_map.every_nth_image = 1;
  config.limits.max_silence_s = 20;
  constexpr int kBatch = 50;
  Random random(11);
  int unusable = 0;
  int complete = 0;
  int said_so = 0;
  for (int begin = 0; begin < number_of_bags(); begin += kBatch) {
    std::vector<fs::path> logs = {whole};
    for (int i = 0; i < kBatch; ++i) {
      std::string bytes = origins[random() % origins.size()];
      for (std::size_t times = 0; times < 1 + random() % 2; ++times)
        kDamages[random() % std::size(kDamages)](bytes, random);
      logs.push_back(folder.path() / ("damaged_" + std::to_string(i) + ".bag"));
      write_bytes(logs.back(), bytes);
    }
    const fs::path output = folder.path() / ("data_" + std::to_string(begin));
    const BuildResult result = build_dataset(config, small_rig(), logs, output);
    ASSERT_FALSE(result.info.flights.empty()) << result.failed.front();
    ASSERT_EQ(result.info.flights[0].name, "whole");
    ASSERT_EQ(result.info.flights.size() + result.failed.size(), logs.size());
    const int all = result.info.flights[0].samples;
    for (std::size_t i = 1; i < result.info.flights.size(); ++i) {
      const FlightEntry& flight = result.info.flights[i];
      const bool is_complete = flight.samples == all;
      const bool says_more = flight.dropped != result.info.flights[0].dropped;
      EXPECT_TRUE(is_complete || says_more) << flight.name << " of " << begin << " lost samples in silence";
      complete += is_complete ? 1 : 0;
      said_so += says_more ? 1 : 0;
    }
    for (const std::string& error : result.failed) {
      EXPECT_THAT(error, ::testing::AllOf(::testing::HasSubstr("damaged_"),
                                          ::testing::Not(::testing::HasSubstr("no progress"))));
    }
    unusable += static_cast<int>(result.failed.size());
    fs::remove_all(output);
  }
  std::printf("%d unusable, %d with every sample, %d that say what was left out\n", unusable, complete,
              said_so);
  EXPECT_GT(unusable, number_of_bags() / 4);
  EXPECT_GT(complete, 0);
  EXPECT_GT(said_so, 0);
  spdlog::set_level(spdlog::level::info);
}

}  // namespace
}  // namespace alight::testing
