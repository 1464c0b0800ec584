#include "sensors/bag/bag_salvage.hpp"

#include <algorithm>
#include <tuple>

#include <rosbag/view.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "sensors/bag/bag_messages.hpp"
#include "tests/sensors/test_flight.hpp"
#include "tests/support/file_text.hpp"

namespace alight::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Content {
  std::string topic;
  std::int64_t receive_ns;
  std::string bytes;
  bool operator==(const Content& other) const {
    return topic == other.topic && receive_ns == other.receive_ns && bytes == other.bytes;
  }
};

std::vector<Content> content_of(BagMessages& bag) {
  std::vector<Content> all;
  while (const auto message = bag.next()) {
    const RawMessage& raw = message->raw;
    const Content one{message->connection->topic, raw.receive_ns,
                      std::string(reinterpret_cast<const char*>(raw.data), raw.size)};
    EXPECT_GE(one.receive_ns, all.empty() ? 0 : all.back().receive_ns);
    all.push_back(one);
  }
  // Messages of one time come in whatever order of their topics.
  std::stable_sort(all.begin(), all.end(), [](const Content& a, const Content& b) {
    return std::tie(a.receive_ns, a.topic) < std::tie(b.receive_ns, b.topic);
  });
  return all;
}

std::vector<Content> content_of(const fs::path& path) {
  BagMessages bag(path);
  return content_of(bag);
}

/// A bag as a killed recorder leaves it: the header says of no index, what stands behind the last chunk is not there.
std::string without_index(std::string bytes) {
  const std::size_t field = bytes.find("index_pos=") + 10;
  std::uint64_t index = 0;
  std::memcpy(&index, bytes.data() + field, 8);
  bytes.replace(field, 8, std::string(8, '\0'));
  return bytes.substr(0, index);
}

class BagSalvaging : public ::testing::TestWithParam<rosbag::compression::CompressionType> {
 protected:
  BagSalvaging() {
    write_flight(folder_.path() / "plain.bag");
    rosbag::Bag plain((folder_.path() / "plain.bag").string(), rosbag::bagmode::Read);
    rosbag::Bag out(whole_.string(), rosbag::bagmode::Write);
    out.setCompression(GetParam());
    out.setChunkThreshold(40'000);  // many chunks
    rosbag::View view(plain);
    for (const rosbag::MessageInstance& message : view)
      out.write(message.getTopic(), message.getTime(), message);
    out.close();
    plain.close();
  }
  ScratchFolder folder_;
  fs::path whole_ = folder_.path() / "whole.bag";
  fs::path killed_ = folder_.path() / "killed.bag";
};

TEST_P(BagSalvaging, AKilledRecordersBagGivesEveryMessageInOrder) {
  write_bytes(killed_, without_index(test::file_text(whole_)));
  EXPECT_TRUE(content_of(killed_) == content_of(whole_));
}

TEST_P(BagSalvaging, ACutOneGivesTheMessagesOfItsWholeChunks) {
  const std::string bytes = without_index(test::file_text(whole_));
  const std::vector<Content> whole = content_of(whole_);
  std::size_t most = 0;
  for (int i = 3; i < 20; ++i) {
    write_bytes(killed_, bytes.substr(0, bytes.size() * static_cast<std::size_t>(i) / 20));
    BagMessages bag(killed_);
    const std::vector<Content> found = content_of(bag);
    ASSERT_GE(found.size(), most);
    ASSERT_LT(found.size(), whole.size());
    // Nothing is missing in between: up to the last time, where the cut may part messages of one time.
    const auto last = std::find_if(found.begin(), found.end(),
                                   [&](const Content& c) { return c.receive_ns == found.back().receive_ns; });
    EXPECT_TRUE(std::equal(found.begin(), last, whole.begin()));
    EXPECT_GT(bag.lost_bytes(), 0u);
    most = found.size();
  }
  EXPECT_GT(most, whole.size() / 2);
}

TEST_P(BagSalvaging, TopicsAreChosenAndCounted) {
  write_bytes(killed_, without_index(test::file_text(whole_)));
  BagMessages killed(killed_);
  BagMessages whole(whole_);
  EXPECT_EQ(killed.count("/livox/lidar"), whole.count("/livox/lidar"));
  EXPECT_EQ(killed.select({"/livox/lidar", "/dji_sdk/attitude"}),
            whole.select({"/livox/lidar", "/dji_sdk/attitude"}));
  EXPECT_EQ(killed.begin_ns(), whole.begin_ns());
  EXPECT_EQ(killed.end_ns(), whole.end_ns());
  EXPECT_TRUE(content_of(killed) == content_of(whole));
  EXPECT_EQ(killed.select({"/nothing"}), 0);
}

std::string compression_name(const ::testing::TestParamInfo<rosbag::compression::CompressionType>& info) {
  return info.param == rosbag::compression::Uncompressed ? "none"
         : info.param == rosbag::compression::BZ2        ? "bz2"
                                                         : "lz4";
}
INSTANTIATE_TEST_SUITE_P(Compressions, BagSalvaging,
                         ::testing::Values(rosbag::compression::Uncompressed, rosbag::compression::BZ2,
                                           rosbag::compression::LZ4),
                         compression_name);

TEST(BagSalvage, WhatIsLostIsCountedInTheSummaryOfTheLog) {
  ScratchFolder folder;
  const fs::path path = folder.path() / "flight.bag";
  write_flight(path);
  const std::string bytes = without_index(test::file_text(path));
  write_bytes(path, bytes.substr(0, bytes.size() - 1000));
  FlightLog log(path, small_rig(), {});
  EXPECT_EQ(log.summary().dropped.count("bytes at the end of a bag without index"), 1u);
}

TEST(BagSalvage, NothingWholeIsAnError) {
  ScratchFolder folder;
  const fs::path path = folder.path() / "flight.bag";
  write_flight(path);
  write_bytes(path, without_index(test::file_text(path)).substr(0, 6000));
  EXPECT_EQ(BagMessages(path).select_all(), 0);
  EXPECT_THAT(message_of<DataError>([&] { FlightLog log(path, small_rig(), {}); }),
              HasSubstr("holds no messages"));
}

}  // namespace
}  // namespace alight::testing
