#include "sensors/stream/flight_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "tests/sensors/test_flight.hpp"

namespace alight::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

template <class Message>
std::vector<Message> all_of(const std::vector<LogMessage>& messages) {
  std::vector<Message> chosen;
  for (const LogMessage& message : messages) {
    if (const auto* one = std::get_if<Message>(&message)) chosen.push_back(*one);
  }
  return chosen;
}

std::string open_error(const fs::path& path, const Rig& rig = small_rig(), const LogConfig& config = {}) {
  return message_of<DataError>([&] { FlightLog log(path, rig, config); });
}

class FlightLogTest : public ::testing::Test {
 protected:
  fs::path bag(const FlightOptions& options = {}) {
    fs::path path = folder_.path() / "flight.bag";
    write_flight(path, options);
    return path;
  }
  /// A whole flight, and with it what `add` writes.
  fs::path bag_with(const FlightOptions& options, const std::function<void(rosbag::Bag&)>& add) {
    const fs::path path = bag(options);
    rosbag::Bag file(path.string(), rosbag::bagmode::Append);
    add(file);
    return path;
  }
  ScratchFolder folder_;
};

TEST_F(FlightLogTest, StreamsEverythingInTheOrderOfRecording) {
  FlightLog log(bag(), small_rig(), {});
  std::vector<std::int64_t> receive_ns;
  LogMessage message;
  std::vector<LogMessage> messages;
  while (log.next(message)) {
    receive_ns.push_back(log.receive_ns());
    messages.push_back(message);
  }
  EXPECT_TRUE(std::is_sorted(receive_ns.begin(), receive_ns.end()));
  EXPECT_EQ(all_of<AttitudeSample>(messages).size(), 300u);
  EXPECT_EQ(all_of<PositionSample>(messages).size(), 150u);
  EXPECT_EQ(all_of<HeightSample>(messages).size(), 150u);
  EXPECT_EQ(all_of<LidarPacket>(messages).size(), 30u);
  const auto frames = all_of<StereoFrame>(messages);
  ASSERT_EQ(frames.size(), 30u);
  EXPECT_EQ(frames[0].t_ns, kStart_ns + 50'000'000);
  EXPECT_EQ(frames[0].left.size(), cv::Size(64, 48));
  EXPECT_EQ(frames[0].right.size(), cv::Size(64, 48));
  EXPECT_EQ(log.consumed(), log.summary().messages);
  EXPECT_EQ(log.summary().topic_messages.at("/left"), 30);
  EXPECT_TRUE(log.summary().dropped.count("images without the other camera's") == 0);
}

TEST_F(FlightLogTest, FindsCompressedTopics) {
  FlightOptions options;
  options.compressed = true;
  FlightLog log(bag(options), small_rig(), {});
  EXPECT_EQ(all_of<StereoFrame>(read_all(log)).size(), 30u);
}

TEST_F(FlightLogTest, AMonoRigNeedsNoRightImages) {
  FlightOptions options;
  options.right = false;
  FlightLog log(bag(options), small_mono_rig(), {});
  const auto frames = all_of<StereoFrame>(read_all(log));
  ASSERT_EQ(frames.size(), 30u);
  EXPECT_TRUE(frames[0].right.empty());
}

TEST_F(FlightLogTest, ShiftsTimesToTheImuClock) {
  Rig rig = small_rig();
  rig.cam0.timeshift_cam_imu_s = 0.004;
  rig.lidar0->timeshift_s = -0.002;
  FlightLog log(bag(), rig, {});
  const auto messages = read_all(log);
  EXPECT_EQ(all_of<StereoFrame>(messages)[0].t_ns, kStart_ns + 54'000'000);
  const auto packet = all_of<LidarPacket>(messages)[0];
  EXPECT_EQ(packet.t_ns, kStart_ns + 50'000'000 - 100'000'000 - 2'000'000);
  EXPECT_EQ(packet.returns[0].t_ns, packet.t_ns);
  EXPECT_EQ(all_of<AttitudeSample>(messages)[0].t_ns, kStart_ns);
}

TEST_F(FlightLogTest, EverySensorHasItsOwnClock) {
  LogConfig config;
  config.attitude_timeshift_s = 0.001;
  config.position_timeshift_s = -0.002;
  config.height_timeshift_s = 0.003;
  FlightLog log(bag(), small_rig(), config);
  const auto messages = read_all(log);
  EXPECT_EQ(all_of<AttitudeSample>(messages)[0].t_ns, kStart_ns + 1'000'000);
  EXPECT_EQ(all_of<PositionSample>(messages)[0].t_ns, kStart_ns - 2'000'000);
  EXPECT_EQ(all_of<HeightSample>(messages)[0].t_ns, kStart_ns + 3'000'000);
}

TEST_F(FlightLogTest, TheReceiveTimeCountsWhereTheRigSaysSo) {
  Rig rig = small_rig();
  rig.lidar0->stamp = StampSource::kReceive;
  rig.cam0.stamp = StampSource::kReceive;
  FlightLog log(bag(), rig, {});
  const auto messages = read_all(log);
  const LidarPacket packet = all_of<LidarPacket>(messages)[0];
  EXPECT_EQ(packet.t_ns, kStart_ns + 50'000'000) << "its header is 0.1 s earlier";
  EXPECT_EQ(packet.returns[0].t_ns, packet.t_ns);
  EXPECT_EQ(all_of<StereoFrame>(messages)[0].t_ns, kStart_ns + 50'000'000);
}

TEST_F(FlightLogTest, CamerasWithClocksApartPairByTheConfiguredLead) {
  FlightOptions options;
  options.left_out = {"/right"};
  const fs::path path = bag_with(options, [](rosbag::Bag& file) {
    const std::int64_t t_ns = kStart_ns + 50'000'000;
    file.write("/right", ros_time(t_ns), image_message(t_ns + 30'000'000, 64, 48, "bgr8"));
  });
  LogConfig config;
  config.right_stamp_lead_s = 0.03;
  FlightLog log(path, small_rig(), config);
  const auto frames = all_of<StereoFrame>(read_all(log));
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].t_ns, kStart_ns + 50'000'000);
  FlightLog unaware(path, small_rig(), {});
  EXPECT_TRUE(all_of<StereoFrame>(read_all(unaware)).empty());
}

TEST_F(FlightLogTest, OneTopicMayBeAttitudeAndPosition) {
  FlightOptions options;
  options.left_out = {"/dji_sdk/attitude", "/dji_sdk/gps_position"};
  const fs::path path = bag_with(options, [](rosbag::Bag& file) {
    for (int i = 0; i < 3; ++i) {
      const std::int64_t t_ns = kStart_ns + i * 10'000'000;
      file.write("/odometry", ros_time(t_ns), odometry_message(t_ns));
      file.write("/tf", ros_time(t_ns), tf_message(t_ns));
    }
  });
  LogConfig config;
  for (const char* topic : {"/odometry", "/tf"}) {
    config.attitude_topic = config.position_topic = topic;
    config.tf_world_frame = "world";
    config.tf_body_frame = "body";
    FlightLog log(path, small_rig(), config);
    const auto messages = read_all(log);
    EXPECT_EQ(all_of<AttitudeSample>(messages).size(), 3u) << topic;
    ASSERT_EQ(all_of<PositionSample>(messages).size(), 3u) << topic;
    EXPECT_EQ(std::get<Eigen::Vector3d>(all_of<PositionSample>(messages)[2].position),
              Eigen::Vector3d(1, 2, 3));
  }
  config.tf_body_frame = "";
  FlightLog log(path, small_rig(), config);
  EXPECT_THAT(message_of<DataError>([&] { read_all(log); }),
              AllOf(HasSubstr("/tf"), HasSubstr("log.tf_body_frame")));
}

TEST_F(FlightLogTest, CountsImagesWithoutTheOtherCamera) {
  const fs::path path = bag_with({}, [](rosbag::Bag& file) {
    const std::int64_t t_ns = kStart_ns + 555'000'000;
    file.write("/left", ros_time(t_ns), image_message(t_ns, 64, 48, "bgr8"));
  });
  FlightLog log(path, small_rig(), {});
  EXPECT_EQ(all_of<StereoFrame>(read_all(log)).size(), 30u);
  EXPECT_EQ(log.summary().dropped.at("images without the other camera's"), 1);
}

TEST_F(FlightLogTest, AttitudeMayComeFromTheImu) {
  FlightOptions options;
  options.left_out = {"/dji_sdk/attitude"};
  const fs::path path = bag_with(options, [](rosbag::Bag& file) {
    sensor_msgs::Imu message;
    message.header = header_at(kStart_ns);
    message.orientation.w = 1;
    file.write("/imu", ros_time(kStart_ns), message);
  });
  LogConfig config;
  config.attitude_topic = "/imu";
  FlightLog log(path, small_rig(), config);
  EXPECT_EQ(all_of<AttitudeSample>(read_all(log)).size(), 1u);
}

TEST_F(FlightLogTest, HeightIsOptional) {
  FlightOptions options;
  options.left_out = {"/dji_sdk/height_above_takeoff"};
  FlightLog log(bag(options), small_rig(), {});
  EXPECT_TRUE(all_of<HeightSample>(read_all(log)).empty());
}

TEST_F(FlightLogTest, NamesFileAndTopicThatIsNotThere) {
  for (const std::string topic :
       {"/left", "/right", "/livox/lidar", "/dji_sdk/attitude", "/dji_sdk/gps_position"}) {
    FlightOptions options;
    options.left_out = {topic};
    EXPECT_THAT(open_error(bag(options)),
                AllOf(HasSubstr("flight.bag"), HasSubstr("no topic " + topic + " "),
                      HasSubstr("/dji_sdk/height_above_takeoff (std_msgs/Float32)")));
  }
}

TEST_F(FlightLogTest, NamesTheWrongTypeAndTheAcceptedOnes) {
  LogConfig config;
  config.attitude_topic = "/dji_sdk/gps_position";
  EXPECT_THAT(
      open_error(bag(), small_rig(), config),
      AllOf(HasSubstr("flight.bag"), HasSubstr("/dji_sdk/gps_position"), HasSubstr("sensor_msgs/NavSatFix"),
            HasSubstr("geometry_msgs/QuaternionStamped, sensor_msgs/Imu")));
}

TEST_F(FlightLogTest, ARigWithoutTopicIsAConfigurationError) {
  Rig rig = small_rig();
  rig.lidar0->topic.clear();
  const fs::path path = bag();
  EXPECT_THAT(message_of<ConfigError>([&] { FlightLog log(path, rig, {}); }),
              HasSubstr("LiDAR has no rostopic"));
}

/// 31 lidar messages of which one lies: 3.2 % of them.
fs::path with_bad_packet(const fs::path& path) {
  rosbag::Bag file(path.string(), rosbag::bagmode::Append);
  livox_ros_driver::CustomMsg message = livox_message(kStart_ns, 3);
  message.point_num = 7;
  file.write("/livox/lidar", ros_time(kStart_ns + 1'000'000'000), message);
  return path;
}

TEST_F(FlightLogTest, SkipsAndCountsABadMessage) {
  LogConfig config;
  config.max_bad_message_share = 0.04;
  FlightLog log(with_bad_packet(bag()), small_rig(), config);
  EXPECT_EQ(all_of<LidarPacket>(read_all(log)).size(), 30u);
  EXPECT_EQ(log.summary().dropped.at("messages that do not decode"), 1);
}

TEST_F(FlightLogTest, TooManyBadMessagesAreFatal) {
  LogConfig config;
  config.max_bad_message_share = 0.03;
  FlightLog log(with_bad_packet(bag()), small_rig(), config);
  EXPECT_THAT(message_of<DataError>([&] { read_all(log); }),
              AllOf(HasSubstr("flight.bag"), HasSubstr("/livox/lidar"), HasSubstr("1 of 31"),
                    HasSubstr("point_num is 7")));
}

TEST_F(FlightLogTest, ImagesOfAnotherSizeThanTheRigsAreFatal) {
  Rig rig = small_rig();
  rig.cam0.camera.intrinsics.width_px = 65;
  FlightLog log(bag(), rig, {});
  EXPECT_THAT(message_of<DataError>([&] { read_all(log); }),
              HasSubstr("64x48 pixels, but the rig's camera has 65x48"));
}

TEST_F(FlightLogTest, CountsMessagesWithoutAFix) {
  const fs::path path = bag_with({}, [](rosbag::Bag& file) {
    sensor_msgs::NavSatFix message = fix_message(kStart_ns);
    message.status.status = sensor_msgs::NavSatStatus::STATUS_NO_FIX;
    file.write("/dji_sdk/gps_position", ros_time(kStart_ns + 1), message);
  });
  FlightLog log(path, small_rig(), {});
  EXPECT_EQ(all_of<PositionSample>(read_all(log)).size(), 150u);
  EXPECT_EQ(log.summary().dropped.at("position messages without a measurement"), 1);
}

TEST(LogConfig, ReadsBackWhatItPrints) {
  LogConfig config;
  config.height_topic.reset();
  config.max_range_m = 123;
  const auto again = parse_config<LogConfig>(print_config(config), "printed");
  EXPECT_FALSE(again.height_topic.has_value());
  EXPECT_EQ(again.max_range_m, 123);
  EXPECT_THROW(parse_config<LogConfig>("min_range_m: 5\nmax_range_m: 4\n", "text"), ConfigError);
}

TEST_F(FlightLogTest, OfImagesOnlyEveryNthIsDecoded) {
  FlightLog every(bag(), small_rig(), {});
  FlightLog fourth(bag(), small_rig(), {});
  fourth.keep_every_nth_image(4);
  const auto all = all_of<StereoFrame>(read_all(every));
  const auto kept = all_of<StereoFrame>(read_all(fourth));
  ASSERT_EQ(kept.size(), (all.size() + 3) / 4);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    EXPECT_EQ(kept[i].t_ns, all[4 * i].t_ns);
    EXPECT_EQ(cv::norm(kept[i].left, all[4 * i].left, cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(kept[i].right, all[4 * i].right, cv::NORM_INF), 0);
  }
  EXPECT_EQ(fourth.summary().dropped.at("images left out by every_nth_image"),
            static_cast<std::int64_t>(all.size() - kept.size()));
}

TEST_F(FlightLogTest, StampsThatJumpAreLeftOutAndCounted) {
  FlightOptions options;
  options.left_out = {"/dji_sdk/attitude", "/livox/lidar"};
  const std::int64_t second_ns = 1'000'000'000;
  FlightLog log(
      bag_with(options,
               [&](rosbag::Bag& file) {
                 for (int i = 0; i < 300; ++i) {
                   const std::int64_t t_ns = kStart_ns + i * second_ns / 100;
                   const std::int64_t stamp_ns = i == 100 ? t_ns + 3600 * second_ns : t_ns;  // once wrong
                   file.write("/dji_sdk/attitude", ros_time(t_ns), attitude_message(stamp_ns));
                   if (i % 10 == 5)
                     file.write("/livox/lidar", ros_time(t_ns), livox_message(i == 105 ? 0 : t_ns, 50));
                 }
               }),
      small_rig(), {});
  const auto messages = read_all(log);
  EXPECT_EQ(all_of<AttitudeSample>(messages).size(), 299u);
  EXPECT_EQ(all_of<LidarPacket>(messages).size(), 29u);
  EXPECT_EQ(log.summary().dropped.at("attitude messages whose stamp jumps"), 1);
  EXPECT_EQ(log.summary().dropped.at("LiDAR messages whose stamp jumps"), 1);
}

}  // namespace
}  // namespace alight::testing
