#include "sensors/messages/decoders.hpp"

#include <cstdlib>
#include <fstream>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "sensors/messages/livox_decoder.hpp"
#include "tests/sensors/messages/cloud_message.hpp"
#include "tests/sensors/messages/decoding.hpp"

namespace alight::testing {
namespace {

struct MessageSample {
  LogRole role;
  std::string type;
  std::vector<std::uint8_t> bytes;
};

/// One message of every row of the table, but for the pictures, which have their own tests.
std::vector<MessageSample> one_of_every_row() {
  sensor_msgs::Imu imu;
  imu.orientation.w = 1;
  std::vector<MessageSample> samples = {
      {LogRole::kImage, "sensor_msgs/Image", bytes_of(image_message(kStart_ns, 5, 3, "bgr8"))},
      {LogRole::kLidar, "livox_ros_driver/CustomMsg", bytes_of(livox_message(kStart_ns, 4))},
      {LogRole::kLidar, "livox_ros_driver2/CustomMsg", bytes_of(livox_message(kStart_ns, 4))},
      {LogRole::kLidar, "sensor_msgs/PointCloud2",
       bytes_of(cloud_message(kStart_ns, velodyne_layout(), {{5, 0, 0, 1, 2, 0.05}, {6, 0, 0, 1, 2, 0.1}}))},
      {LogRole::kAttitude, "geometry_msgs/QuaternionStamped", bytes_of(attitude_message(kStart_ns))},
      {LogRole::kAttitude, "sensor_msgs/Imu", bytes_of(imu)},
      {LogRole::kPosition, "sensor_msgs/NavSatFix", bytes_of(fix_message(kStart_ns))},
      {LogRole::kPosition, "geometry_msgs/PointStamped", bytes_of(geometry_msgs::PointStamped())},
      {LogRole::kHeight, "std_msgs/Float32", bytes_of(float_message(1))},
      {LogRole::kCameraInfo, "sensor_msgs/CameraInfo", bytes_of(camera_info_message(kStart_ns))},
  };
  for (const LogRole role : {LogRole::kAttitude, LogRole::kPosition}) {
    samples.push_back({role, "geometry_msgs/PoseStamped", bytes_of(pose_message(kStart_ns))});
    samples.push_back({role, "nav_msgs/Odometry", bytes_of(odometry_message(kStart_ns))});
    samples.push_back({role, "geometry_msgs/TransformStamped", bytes_of(transform_message(kStart_ns))});
    samples.push_back({role, "tf2_msgs/TFMessage", bytes_of(tf_message(kStart_ns))});
    samples.push_back({role, "tf/tfMessage", bytes_of(tf_message(kStart_ns))});
  }
  return samples;
}

DecodeOptions world_to_body() {
  DecodeOptions options;
  options.frames = {"world", "body"};
  return options;
}

TEST(Decoders, EveryRowRefusesEveryCutOffMessageAndTrailingBytes) {
  const DecodeOptions options = world_to_body();
  std::set<std::pair<LogRole, std::string>> covered;
  for (const auto& [role, type, bytes] : one_of_every_row()) {
    covered.insert({role, type});
    EXPECT_TRUE(decode(role, type, bytes, kStart_ns, options).has_value()) << type;
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::vector<std::uint8_t> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_THROW(decode(role, type, cut, kStart_ns, options), DecodeError) << type << " " << size;
    }
    std::vector<std::uint8_t> longer = bytes;
    longer.push_back(0);
    EXPECT_THROW(decode(role, type, longer, kStart_ns, options), DecodeError) << type;
  }
  for (const Decoder& decoder : decoders()) {
    const bool picture = decoder.type == "sensor_msgs/CompressedImage";
    EXPECT_TRUE(picture || covered.count({decoder.role, decoder.type}) != 0) << decoder.type;
  }
}

/// Damaged bytes either still make a message or are a DecodeError: nothing else is thrown, nothing is read that is not
/// there (the sanitizers see that).
TEST(Decoders, DamagedMessagesAreDecodeErrorsAtWorst) {
  std::mt19937 random(5);
  int refused = 0;
  for (const auto& [role, type, bytes] : one_of_every_row()) {
    for (int i = 0; i < 3000; ++i) {
      std::vector<std::uint8_t> damaged = bytes;
      const int flips = 1 + i % 4;
      for (int k = 0; k < flips; ++k)
        damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
      try {
        decode(role, type, damaged, kStart_ns, world_to_body());
      } catch (const DecodeError&) {
        ++refused;
      }
    }
  }
  EXPECT_GT(refused, 10'000);
}

TEST(Decoders, AMessageTypeIsFoundOnlyForItsRole) {
  EXPECT_EQ(find_decoder(LogRole::kLidar, "sensor_msgs/Image"), nullptr);
  EXPECT_EQ(
      accepted_types(LogRole::kPosition),
      "sensor_msgs/NavSatFix, geometry_msgs/PointStamped, geometry_msgs/PoseStamped, nav_msgs/Odometry, "
      "geometry_msgs/TransformStamped, tf2_msgs/TFMessage, tf/tfMessage");
}

/// In a process of its own: a row stays.
TEST(Decoders, ARowOfTheUsersOwnIsFound) {
  EXPECT_EXIT(
      {
        const Decoder* before = find_decoder(LogRole::kLidar, "sensor_msgs/PointCloud2");
        add_decoder({"acme_msgs/Sweep", "md5", LogRole::kLidar, decode_livox});
        const Decoder* row = find_decoder(LogRole::kLidar, "acme_msgs/Sweep");
        const bool stayed = before == find_decoder(LogRole::kLidar, "sensor_msgs/PointCloud2");
        std::exit(row != nullptr && row->decode == decode_livox && stayed ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST(Decoders, ATypeThatIsReadAlreadyGetsNoSecondRow) {
  EXPECT_THROW(add_decoder({"sensor_msgs/PointCloud2", "md5", LogRole::kLidar, decode_livox}), ConfigError);
}

/// tests/fuzz/types.txt; of several names of one message, one is enough.
TEST(Decoders, EveryDecodeFunctionHasAFuzzTarget) {
  std::ifstream file(ALIGHT_SOURCE_DIR "/tests/fuzz/types.txt");
  std::set<std::string> fuzzed;
  for (std::string type; std::getline(file, type);) fuzzed.insert(type);
  std::set<DecodeFunction> covered;
  for (const Decoder& decoder : decoders()) {
    if (fuzzed.count(decoder.type) != 0) covered.insert(decoder.decode);
  }
  for (const Decoder& decoder : decoders()) EXPECT_EQ(covered.count(decoder.decode), 1u) << decoder.type;
}

}  // namespace
}  // namespace alight::testing
