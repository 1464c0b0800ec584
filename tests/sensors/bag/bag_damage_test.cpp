#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "sensors/bag/bag_check.hpp"
#include "tests/sensors/test_flight.hpp"
#include "tests/support/file_text.hpp"

namespace alight::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string read_error(const fs::path& path) {
  return message_of<DataError>([&] {
    FlightLog log(path, small_rig(), {});
    read_all(log);
  });
}

class BagDamage : public ::testing::Test {
 protected:
  BagDamage() { write_flight(path_, short_flight()); }
  static FlightOptions short_flight() {
    FlightOptions options;
    options.duration_s = 0.5;
    return options;
  }
  ScratchFolder folder_;
  fs::path path_ = folder_.path() / "flight.bag";
};

TEST_F(BagDamage, AMissingFileAndAFolderAreNamed) {
  EXPECT_THAT(read_error(folder_.path() / "none.bag"),
              AllOf(HasSubstr("none.bag"), HasSubstr("no such file")));
  EXPECT_THAT(read_error(folder_.path()), HasSubstr("is no file"));
}

TEST_F(BagDamage, ATextFileIsNoBag) {
  write_bytes(path_, "hello, I am not a bag\n");
  EXPECT_THAT(read_error(path_), AllOf(HasSubstr("flight.bag"), HasSubstr("no ROS 1 bag")));
}

TEST_F(BagDamage, AnEmptyFileSaysSo) {
  write_bytes(path_, "");
  EXPECT_THAT(read_error(path_), AllOf(HasSubstr("flight.bag"), HasSubstr("0 bytes")));
}

TEST_F(BagDamage, ABagWithoutMessagesSaysSo) {
  rosbag::Bag(path_.string(), rosbag::bagmode::Write).close();
  EXPECT_THAT(read_error(path_), AllOf(HasSubstr("flight.bag"), HasSubstr("no messages")));
}

TEST_F(BagDamage, EveryTruncationIsADataError) {
  const std::string whole = test::file_text(path_);
  ASSERT_EQ(read_error(path_), "");
  for (int i = 0; i < 40; ++i) {
    const std::size_t size =
        whole.size() * static_cast<std::size_t>(i) / 40 + static_cast<std::size_t>(i) % 13;
    write_bytes(path_, whole.substr(0, size));
    EXPECT_THAT(read_error(path_), HasSubstr("flight.bag")) << size;
  }
}

/// Flipped bytes anywhere: the log is read or refused, the process never dies of it. Flips inside a message
/// may go unnoticed, since bags carry no checksum; flips of lengths must not.
TEST_F(BagDamage, FlippedBytesNeverCrash) {
  const std::string whole = test::file_text(path_);
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string bytes = whole;
    for (int flip = 0; flip < 20; ++flip) bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
    for (int flip = 0; flip < 2;
         ++flip) {  // the tail holds the index and the connections: lengths side by side
      bytes[bytes.size() - 1 - random() % 4000] = static_cast<char>(random() % 256);
    }
    write_bytes(path_, bytes);
    if (!read_error(path_).empty()) ++refused;
  }
  EXPECT_GT(refused, 100);
}

TEST_F(BagDamage, TheStructureOfAWholeBagPasses) { EXPECT_NO_THROW(check_bag_structure(path_)); }

}  // namespace
}  // namespace alight::testing
