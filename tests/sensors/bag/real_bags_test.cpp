#include <rosbag/view.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "sensors/bag/bag_messages.hpp"
#include "sensors/messages/decoders.hpp"
#include "tests/sensors/test_flight.hpp"

namespace alight::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// Bags that other programs recorded. They are beside the repository on the machines that have them.
class RealBags : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::is_directory(kData)) GTEST_SKIP() << kData << " is not there";
  }
  static std::string open_error(const std::string& file, const LogConfig& config = {}) {
    return message_of<DataError>([&] { FlightLog log(kData / file, small_rig(), config); });
  }
  static const fs::path kData;
};
const fs::path RealBags::kData = fs::path(ALIGHT_SOURCE_DIR) / ".." / "shared" / "data";

TEST_F(RealBags, BrokenOnesAreRefusedByName) {
  EXPECT_THAT(open_error("bag_broken_cases/test_truncated.bag"), HasSubstr("test_truncated.bag"));
  EXPECT_THAT(open_error("bag_same_content_none_bz2_lz4/empty-file.bag"), HasSubstr("0 bytes"));
  EXPECT_THAT(open_error("bag_same_content_none_bz2_lz4/no-messages.bag"), HasSubstr("no messages"));
}

TEST_F(RealBags, OnesOfAnotherRobotNameTheTopicsTheyHave) {
  for (const char* file : {"example.bag", "example-bz2.bag", "example-lz4.bag"}) {
    EXPECT_THAT(open_error(std::string("bag_same_content_none_bz2_lz4/") + file),
                AllOf(HasSubstr("no topic /left"), HasSubstr("/turtle1/pose")))
        << file;
  }
}

TEST_F(RealBags, OneWhoseRecorderWasKilledIsReadAsFarAsItGoes) {
  BagMessages killed(kData / "bag_broken_cases" / "test_unindexed.bag");
  int messages = 0;
  std::int64_t last_ns = 0;
  while (const auto message = killed.next()) {
    EXPECT_GE(message->raw.receive_ns, last_ns);
    last_ns = message->raw.receive_ns;
    ++messages;
  }
  EXPECT_EQ(messages, 14);  // as many as in test_sample.bag, of which it is a copy
}

TEST_F(RealBags, TheThreeCompressionsHoldTheSameMessages) {
  const auto content = [](const char* file) {
    BagMessages bag(kData / "bag_same_content_none_bz2_lz4" / file);
    std::vector<std::string> all;
    while (const auto message = bag.next())
      all.push_back(message->connection->topic + std::to_string(message->raw.receive_ns) +
                    std::string(reinterpret_cast<const char*>(message->raw.data), message->raw.size));
    return all;
  };
  const auto plain = content("example.bag");
  EXPECT_GT(plain.size(), 0u);
  EXPECT_EQ(plain, content("example-bz2.bag"));
  EXPECT_EQ(plain, content("example-lz4.bag"));
}

/// All messages of a topic through the decoder of their type.
std::vector<std::optional<DecodedMessage>> decode_topic(const fs::path& path, const std::string& topic,
                                                        LogRole role) {
  struct Sink {
    std::vector<std::uint8_t> bytes;
    std::uint8_t* advance(std::uint32_t size) {
      bytes.resize(size);
      return bytes.data();
    }
  };
  rosbag::Bag bag(path.string(), rosbag::bagmode::Read);
  rosbag::View view(bag, rosbag::TopicQuery(topic));
  std::vector<std::optional<DecodedMessage>> decoded;
  for (const rosbag::MessageInstance& message : view) {
    Sink sink;
    message.write(sink);
    const Decoder* decoder = find_decoder(role, message.getDataType());
    EXPECT_EQ(decoder->md5, message.getMD5Sum());
    decoded.push_back(decoder->decode({sink.bytes.data(), sink.bytes.size(), 0}, {}));
  }
  return decoded;
}

TEST_F(RealBags, ARealCamerasJpegDecodes) {
  const auto images = decode_topic(kData / "bag_image_jpeg_camera_info" / "aruco_marker.bag",
                                   "/raspicam_node/image/compressed", LogRole::kImage);
  ASSERT_EQ(images.size(), 1u);
  const cv::Mat image = std::get<CameraImage>(images[0].value()).image;
  EXPECT_EQ(image.type(), CV_8UC3);
  EXPECT_GE(image.cols, 640);
}

TEST_F(RealBags, RealInertialUnitsAndReceiversDecode) {
  const fs::path husky = kData / "bag_husky_gps_imu_odom" / "test1.bag";
  const fs::path xsens = kData / "bag_xsens_gps_imu_scan" / "tilt_laser.bag";
  EXPECT_EQ(decode_topic(husky, "/imu/data", LogRole::kAttitude).size(), 11865u);
  EXPECT_EQ(decode_topic(xsens, "/imu_data", LogRole::kAttitude).size(), 356u);
  EXPECT_EQ(decode_topic(xsens, "/position_gps", LogRole::kPosition).size(), 356u);
  int fixes = 0;
  for (const auto& fix : decode_topic(husky, "/fix", LogRole::kPosition)) fixes += fix.has_value() ? 1 : 0;
  EXPECT_EQ(fixes, 989);
}

}  // namespace
}  // namespace alight::testing
