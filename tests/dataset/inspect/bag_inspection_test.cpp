#include "dataset/inspect/bag_inspection.hpp"

#include <map>
#include <sstream>

#include <std_msgs/String.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dataset/inspect/rig_suggestion.hpp"
#include "foundation/errors.hpp"
#include "tests/sensors/messages/cloud_message.hpp"
#include "tests/sensors/test_flight.hpp"
#include "tests/support/programs.hpp"

namespace alight::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const TopicReport& topic(const BagReport& report, const std::string& name) {
  for (const TopicReport& topic : report.topics) {
    if (topic.topic == name) return topic;
  }
  throw std::out_of_range(name);
}

class BagInspection : public ::testing::Test {
 protected:
  fs::path bag_of(const std::function<void(rosbag::Bag&)>& write) {
    fs::path path = folder_.path() / "a.bag";
    rosbag::Bag bag(path.string(), rosbag::bagmode::Write);
    write(bag);
    return path;
  }
  fs::path flight(const FlightOptions& options = {}) {
    fs::path path = folder_.path() / "flight.bag";
    write_flight(path, options);
    return path;
  }
  ScratchFolder folder_;
};

TEST_F(BagInspection, CountsRatesSpansAndGapsAreThoseOfTheRecording) {
  const BagReport report = inspect_bag(flight());
  EXPECT_EQ(report.messages, 300 + 150 + 150 + 30 + 30 + 30);
  EXPECT_EQ(report.begin_ns, kStart_ns);
  EXPECT_EQ(report.end_ns, kStart_ns + 2'990'000'000);
  const TopicReport& attitude = topic(report, "/dji_sdk/attitude");
  EXPECT_EQ(attitude.type, "geometry_msgs/QuaternionStamped");
  EXPECT_EQ(attitude.messages, 300);
  EXPECT_NEAR(attitude.rate_hz(), 100, 1e-9);
  EXPECT_NEAR(attitude.longest_gap_s, 0.01, 1e-9);
  EXPECT_NE(attitude.serves_as(LogRole::kAttitude), nullptr);
  EXPECT_EQ(attitude.serves_as(LogRole::kPosition), nullptr);
  EXPECT_NE(topic(report, "/left").serves_as(LogRole::kImage), nullptr);
  EXPECT_NE(topic(report, "/livox/lidar").serves_as(LogRole::kLidar), nullptr);
  EXPECT_FALSE(topic(report, "/dji_sdk/height_above_takeoff").offset.has_value()) << "has no header";
}

TEST_F(BagInspection, ClockOffsetsAreReceiveTimeMinusStamp) {
  const BagReport report = inspect_bag(flight());
  ASSERT_TRUE(topic(report, "/livox/lidar").offset.has_value());
  EXPECT_NEAR(topic(report, "/livox/lidar").offset->median_s, 0.1, 1e-6);
  EXPECT_NEAR(topic(report, "/left").offset->max_s, 0, 1e-6);
}

TEST_F(BagInspection, GapsAreCountedAndTheLongestIsPlaced) {
  const BagReport report = inspect_bag(bag_of([](rosbag::Bag& bag) {
    for (const int ms : {0, 10, 20, 60, 70, 80, 90, 390, 400, 410})
      bag.write("/attitude", ros_time(kStart_ns + ms * 1'000'000), attitude_message(kStart_ns));
  }));
  const TopicReport& attitude = topic(report, "/attitude");
  EXPECT_EQ(attitude.gaps, 2);
  EXPECT_NEAR(attitude.longest_gap_s, 0.3, 1e-9);
  EXPECT_EQ(attitude.longest_gap_ns, kStart_ns + 90'000'000);
}

TEST_F(BagInspection, UnknownTypesAreListedAndSkipped) {
  const BagReport report = inspect_bag(bag_of([](rosbag::Bag& bag) {
    bag.write("/chatter", ros_time(kStart_ns), std_msgs::String());
    bag.write("/attitude", ros_time(kStart_ns + 1), attitude_message(kStart_ns));
  }));
  EXPECT_FALSE(topic(report, "/chatter").known_type);
  EXPECT_TRUE(topic(report, "/chatter").roles.empty());
  EXPECT_EQ(topic(report, "/chatter").messages, 1);
  EXPECT_EQ(topic(report, "/chatter").rate_hz(), 0);
}

TEST_F(BagInspection, SaysWhyAKnownTypeHoldsNoMeasurement) {
  const BagReport report = inspect_bag(bag_of([](rosbag::Bag& bag) {
    sensor_msgs::Imu imu;
    imu.orientation_covariance[0] = -1;
    bag.write("/imu", ros_time(kStart_ns), imu);
    bag.write("/zero", ros_time(kStart_ns), sensor_msgs::Imu());
  }));
  EXPECT_EQ(topic(report, "/imu").serves_as(LogRole::kAttitude), nullptr);
  EXPECT_EQ(topic(report, "/imu").roles.at(0).tried, 1);
  EXPECT_THAT(topic(report, "/zero").roles.at(0).first_problem, HasSubstr("quaternion of length 0"));
}

TEST_F(BagInspection, ListsTheFramesOfTransforms) {
  const BagReport report = inspect_bag(bag_of([](rosbag::Bag& bag) {
    bag.write("/tf_static", ros_time(kStart_ns), tf_message(kStart_ns));
    for (int i = 0; i < 2; ++i) bag.write("/tf", ros_time(kStart_ns + i), tf_message(kStart_ns));
  }));
  EXPECT_EQ(topic(report, "/tf").frames,
            (std::set<std::pair<std::string, std::string>>{{"world", "body"}, {"world", "lidar"}}));
  EXPECT_THAT(suggest_configuration(report),
              AllOf(HasSubstr("attitude_topic: /tf\n"), HasSubstr("tf_world_frame: FILL_IN")));
}

TEST_F(BagInspection, ABagWithoutMessagesIsReportedAsOne) {
  const BagReport report = inspect_bag(bag_of([](rosbag::Bag&) {}));
  EXPECT_EQ(report.messages, 0);
  EXPECT_EQ(suggest_configuration(report), "");
}

/// What cannot be known is FILL_IN; once that is filled in, the lines are a rig file and the section of a log.
TEST_F(BagInspection, TheSuggestionReadsTheBag) {
  const fs::path path = flight();
  rosbag::Bag bag(path.string(), rosbag::bagmode::Append);
  for (const char* name : {"/left/camera_info", "/right/camera_info"})
    bag.write(name, ros_time(kStart_ns + 1), camera_info_message(kStart_ns));
  bag.close();
  std::string text = suggest_configuration(inspect_bag(path));
  for (std::size_t at; (at = text.find("FILL_IN")) != std::string::npos;)
    text.replace(at, 7,
                 text.compare(at - 11, 9, "T_cn_cnm1") == 0
                     ? "[[1, 0, 0, -0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"
                     : "[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]");
  const std::size_t log_at = text.find("log:\n");
  ASSERT_NE(log_at, std::string::npos);
  const Rig rig = parse_rig(text.substr(0, log_at), "suggestion");
  EXPECT_EQ(rig.cam0.topic, "/left");
  ASSERT_TRUE(rig.cam1.has_value());
  EXPECT_EQ(rig.cam1->topic, "/right");
  EXPECT_EQ(rig.cam0.camera.intrinsics, (PinholeIntrinsics{44, 45, 31.5, 23.5, 64, 48}));
  EXPECT_EQ(rig.lidar0->topic, "/livox/lidar");
  EXPECT_THAT(text,
              AllOf(HasSubstr("attitude_topic: /dji_sdk/attitude\n"),
                    HasSubstr("position_topic: /dji_sdk/gps_position\n"),
                    HasSubstr("height_topic: /dji_sdk/height_above_takeoff\n"), Not(HasSubstr("receive"))));
}

TEST_F(BagInspection, SuggestsThePeriodOfCloudsWithoutTimesAndTheReceiveTimeOfBadClocks) {
  const std::string text = suggest_configuration(inspect_bag(bag_of([](rosbag::Bag& bag) {
    for (int i = 0; i < 5; ++i) {
      bag.write("/points", ros_time(kStart_ns + i * 100'000'000),
                cloud_message(42 + i * 100'000'000, livox_layout(), {{5, 0, 0, 1, 0, 0}}));
    }
  })));
  EXPECT_THAT(text, AllOf(HasSubstr("scan_period_s: 0.1 "), HasSubstr("stamp: receive"),
                          HasSubstr("rostopic: /points")));
}

/// The bags of other programs, on machines that have them.
class RealBagInspection : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!fs::is_directory(kData)) GTEST_SKIP() << kData << " is not there";
  }
  static std::vector<fs::path> bags() {
    std::vector<fs::path> bags;
    for (const auto& entry : fs::recursive_directory_iterator(kData)) {
      if (entry.path().extension() == ".bag") bags.push_back(entry.path());
    }
    return bags;
  }
  static const fs::path kData;
};
const fs::path RealBagInspection::kData = fs::path(ALIGHT_SOURCE_DIR) / ".." / "shared" / "data";

struct TopicCount {
  std::string type;
  std::int64_t messages = 0;
};
bool operator==(const TopicCount& a, const TopicCount& b) {
  return a.type == b.type && a.messages == b.messages;
}

/// What rosbag's Python module counts; empty where it refuses the bag.
std::map<std::string, TopicCount> counts_of_python(const fs::path& path) {
  const std::string command =
      "/usr/bin/python3 -c \"import rosbag, sys\n"
      "bag = rosbag.Bag(sys.argv[1], allow_unindexed=True)\n"
      "if not bag._chunks: list(bag.reindex())\n"
      "for name, t in bag.get_type_and_topic_info()[1].items():\n"
      "  print(name, t.msg_type, t.message_count)\" '" +
      path.string() + "' 2>/dev/null";
  std::istringstream lines(test::run_command(command).out);
  std::map<std::string, TopicCount> counts;
  std::string name;
  TopicCount count;
  while (lines >> name >> count.type >> count.messages) counts[name] = count;
  return counts;
}

TEST_F(RealBagInspection, CountsAreThoseOfRosbagsPythonModule) {
  if (!test::python_has("rosbag")) GTEST_SKIP() << "python3-rosbag is not installed";
  int compared = 0;
  for (const fs::path& path : bags()) {
    BagReport report;
    try {
      report = inspect_bag(path);
    } catch (const DataError& e) {
      EXPECT_THAT(e.what(), HasSubstr(path.filename().string()));
      continue;
    }
    std::map<std::string, TopicCount> counts;
    for (const TopicReport& one : report.topics) {
      if (one.messages == 0) continue;
      counts[one.topic].type = one.type;
      counts[one.topic].messages += one.messages;
    }
    for (const auto& [name, count] : report.without_time) counts[name].messages += count;
    std::map<std::string, TopicCount> expected = counts_of_python(path);
    for (auto at = expected.begin(); at != expected.end();)
      at = at->second.messages == 0 ? expected.erase(at) : std::next(at);
    EXPECT_TRUE(counts == expected) << path;
    ++compared;
  }
  EXPECT_GE(compared, 12);
}

TEST_F(RealBagInspection, TheRealSensorsServeAsWhatTheyAre) {
  const BagReport husky = inspect_bag(kData / "bag_husky_gps_imu_odom" / "test1.bag");
  EXPECT_NE(topic(husky, "/fix").serves_as(LogRole::kPosition), nullptr);
  EXPECT_NE(topic(husky, "/imu/data").serves_as(LogRole::kAttitude), nullptr);
  const BagReport luminar = inspect_bag(kData / "bag_pointcloud2_luminar_lz4" / "test.bag");
  int clouds = 0;
  for (const TopicReport& one : luminar.topics) {
    const RoleTrial* lidar = one.serves_as(LogRole::kLidar);
    if (lidar == nullptr) continue;
    ++clouds;
    EXPECT_GT(std::get<LidarPacket>(*lidar->example).returns.size(), 1000u) << one.topic;
  }
  EXPECT_EQ(clouds, 1);
  EXPECT_EQ(inspect_bag(kData / "bag_pointcloud2_luminar_lz4" / "array_test.bag").without_time,
            (std::map<std::string, std::int64_t>{{"/array_test", 1}}));
  const BagReport camera = inspect_bag(kData / "bag_image_jpeg_camera_info" / "aruco_marker.bag");
  EXPECT_THAT(suggest_configuration(camera),
              AllOf(HasSubstr("rostopic: /raspicam_node/image\n"), HasSubstr("/raspicam_node/camera_info")));
}

}  // namespace
}  // namespace alight::testing
