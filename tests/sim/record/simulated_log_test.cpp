#include "sim/record/simulated_log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "geometry/depth_map.hpp"
#include "geometry/frames.hpp"
#include "geometry/geodesy.hpp"
#include "geometry/rig/stereo_rectification.hpp"
#include "geometry/trajectory.hpp"
#include "sensors/messages/livox_custom_msg.hpp"
#include "sim/record/message_maker.hpp"
#include "sim/record/message_schedule.hpp"
#include "sim/record/sensor_messages.hpp"
#include "sim/record/simulated_flight.hpp"
#include "sim/sensors/livox_scan.hpp"
#include "tests/support/file_text.hpp"
#include "tests/support/programs.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight::sim {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLeftTopic = "/mynteye/left/image_raw/compressed";
constexpr const char* kRightTopic = "/mynteye/right/image_raw/compressed";
constexpr const char* kLidarTopic = "/livox/lidar";
constexpr std::int64_t kStart_ns = 1'700'000'000 * kNanosecondsPerSecond;

/// The paper's rig with a quarter of the resolution: the same geometry at a sixteenth of the time.
Rig small_rig() {
  Rig rig = load_rig(std::string(ALIGHT_SOURCE_DIR) + "/configs/rigs/paper.yaml");
  for (RigCamera* camera : {&rig.cam0, &*rig.cam1})
    camera->camera.intrinsics = {110, 110, 79.5, 49.5, 160, 100};
  return rig;
}

class FlightRecorderTest : public testing::Test {
 protected:
  FlightRecorderTest() { std::ofstream(rig_file()) << format_rig(small_rig()); }
  std::string rig_file() const { return (folder_ / "rig.yaml").string(); }

  /// One second over a small field, straight on while turning.
  SimConfig config(std::vector<std::string> overrides = {}) const {
    overrides.push_back("rig=" + rig_file());
    overrides.emplace_back("flights.0.plan.duration_s=1");
    return load_config<SimConfig>(std::string(ALIGHT_SOURCE_DIR) + "/configs/sim/quick.yaml", overrides);
  }
  RecordedFlight record(const SimConfig& c, const std::string& output = "out") const {
    return FlightRecorder(c, folder_ / output).record(c.flights.front());
  }
  fs::path bag_path(const std::string& output = "out") const { return folder_ / output / "quick.bag"; }
  fs::path truth_path(const std::string& output = "out") const { return folder_ / output / "quick.truth"; }

  const alight::test::ScratchFolder folder_;
};

/// Bag time and content of every message of a topic.
template <class Message>
std::vector<std::pair<std::int64_t, Message>> read(const fs::path& path, const std::string& topic) {
  rosbag::Bag bag(path.string());
  std::vector<std::pair<std::int64_t, Message>> messages;
  for (const rosbag::MessageInstance& instance : rosbag::View(bag, rosbag::TopicQuery(topic))) {
    const boost::shared_ptr<Message> message = instance.instantiate<Message>();
    if (message == nullptr) throw std::runtime_error(topic + " is of another type");
    messages.emplace_back(static_cast<std::int64_t>(instance.getTime().toNSec()), *message);
  }
  return messages;
}

template <class Message>
std::int64_t stamp_ns(const Message& message) {
  return static_cast<std::int64_t>(message.header.stamp.toNSec());
}

TEST_F(FlightRecorderTest, SameSeedGivesTheSameBytesWithAnyNumberOfThreads) {
  record(config({"recorder.threads=1"}), "one");
  record(config({"recorder.threads=3"}), "three");
  EXPECT_EQ(alight::test::file_text(bag_path("one")), alight::test::file_text(bag_path("three")));
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(truth_path("one"))) {
    const fs::path relative = fs::relative(entry.path(), truth_path("one"));
    if (!entry.is_regular_file() || relative == "truth.yaml")
      continue;  // that one holds the number of threads
    EXPECT_EQ(alight::test::file_text(entry.path()), alight::test::file_text(truth_path("three") / relative))
        << relative;
    ++files;
  }
  EXPECT_EQ(files, 20U + 20U + 2U);
  record(config({"flights.0.seed=8"}), "other");
  EXPECT_NE(alight::test::file_text(bag_path("one")), alight::test::file_text(bag_path("other")));
}

TEST_F(FlightRecorderTest, RatesAndCountsAreAsConfigured) {
  const RecordedFlight recorded = record(config({"sensors.imu.rate_hz=400", "recorder.compression=lz4"}));
  EXPECT_EQ(recorded.frames, 20);
  EXPECT_EQ(recorded.lidar_packets, 10);
  EXPECT_EQ(recorded.bag_bytes, fs::file_size(bag_path()));
  rosbag::Bag bag(bag_path().string());
  rosbag::View view(bag);
  std::map<std::string, int> counts;
  std::map<std::string, std::string> types;
  ros::Time last(0, 0);
  for (const rosbag::MessageInstance& message : view) {
    ++counts[message.getTopic()];
    types[message.getTopic()] = message.getDataType();
    EXPECT_GE(message.getTime(), last);
    last = message.getTime();
  }
  const std::map<std::string, int> expected = {{kLeftTopic, 20},      {kRightTopic, 20}, {kLidarTopic, 10},
                                               {kAttitudeTopic, 101}, {kImuTopic, 401},  {kPositionTopic, 51},
                                               {kHeightTopic, 51}};
  EXPECT_EQ(counts, expected);
  EXPECT_EQ(types.at(kLidarTopic), "livox_ros_driver/CustomMsg");
  EXPECT_EQ(types.at(kHeightTopic), "std_msgs/Float32");
  EXPECT_EQ(recorded.messages, static_cast<std::int64_t>(view.size()));
}

TEST_F(FlightRecorderTest, StampsFollowEachSensorsClock) {
  record(config({"sensors.camera.clock_offset_s=0.25", "sensors.lidar.clock_offset_s=-0.5",
                 "sensors.pose_clock_offset_s=2"}));
  const auto left = read<sensor_msgs::CompressedImage>(bag_path(), kLeftTopic);
  const auto right = read<sensor_msgs::CompressedImage>(bag_path(), kRightTopic);
  ASSERT_EQ(left.size(), right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    const std::int64_t exposed_ns = kStart_ns + 13'000'000 + static_cast<std::int64_t>(i) * 50'000'000;
    EXPECT_EQ(stamp_ns(left[i].second), exposed_ns + 250'000'000);
    EXPECT_EQ(stamp_ns(right[i].second), stamp_ns(left[i].second));
    EXPECT_EQ(left[i].first, exposed_ns + 15'000'000);
    EXPECT_TRUE(fs::exists(truth_path() / "depth" / (std::to_string(stamp_ns(left[i].second)) + ".png")));
  }
  const auto lidar = read<livox_ros_driver::CustomMsg>(bag_path(), kLidarTopic);
  for (std::size_t i = 0; i < lidar.size(); ++i) {
    const std::int64_t begin_ns = kStart_ns + static_cast<std::int64_t>(i) * 100'000'000;
    EXPECT_EQ(stamp_ns(lidar[i].second), begin_ns - 500'000'000);
    EXPECT_EQ(static_cast<std::int64_t>(lidar[i].second.timebase), begin_ns - 500'000'000);
    EXPECT_EQ(lidar[i].first, begin_ns + 102'000'000);
    ASSERT_EQ(lidar[i].second.points.size(), 10'000U);
    EXPECT_EQ(lidar[i].second.point_num, 10'000U);
    EXPECT_EQ(lidar[i].second.points.back().offset_time, 99'990'000U);
  }
  const auto attitude = read<geometry_msgs::QuaternionStamped>(bag_path(), kAttitudeTopic);
  EXPECT_EQ(stamp_ns(attitude.front().second), kStart_ns + 2 * kNanosecondsPerSecond);
  const Rig rig = load_rig(truth_path() / "rig.yaml");
  EXPECT_NEAR(rig.cam0.timeshift_cam_imu_s, 1.75, 1e-9);
  EXPECT_NEAR(rig.lidar0->timeshift_s, 2.5, 1e-9);
}

/// Poses as a reader of the bag makes them, from the messages alone.
Trajectory read_poses(const fs::path& bag) {
  Trajectory trajectory(0.1);
  std::unique_ptr<LocalEnu> world;
  for (const auto& [t_ns, message] : read<sensor_msgs::NavSatFix>(bag, kPositionTopic)) {
    if (!world) world = std::make_unique<LocalEnu>(message.latitude, message.longitude, message.altitude);
    EXPECT_TRUE(trajectory.add_position(
        stamp_ns(message), world->to_world(message.latitude, message.longitude, message.altitude)));
  }
  for (const auto& [t_ns, message] : read<geometry_msgs::QuaternionStamped>(bag, kAttitudeTopic)) {
    const geometry_msgs::Quaternion& q = message.quaternion;
    EXPECT_TRUE(trajectory.add_attitude(stamp_ns(message), Eigen::Quaterniond(q.w, q.x, q.y, q.z)));
  }
  return trajectory;
}

TEST_F(FlightRecorderTest, AReaderGetsTheTrueTrajectory) {
  record(config({"sensors.noise=off"}));
  const Trajectory trajectory = read_poses(bag_path());
  std::istringstream rows(alight::test::file_text(truth_path() / "trajectory.csv"));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row, "t_ns,x_m,y_m,z_m,qw,qx,qy,qz");
  int poses = 0;
  double position_m = 0;
  double angle_rad = 0;
  while (std::getline(rows, row)) {
    long long t_ns = 0;
    std::array<double, 7> v{};
    ASSERT_EQ(std::sscanf(row.c_str(), "%lld,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &t_ns, &v[0], &v[1], &v[2], &v[3],
                          &v[4], &v[5], &v[6]),
              8);
    const auto T = trajectory.T_world_imu(t_ns);
    ASSERT_TRUE(T.has_value());
    position_m = std::max(position_m, (T->translation() - Eigen::Vector3d(v[0], v[1], v[2])).norm());
    angle_rad =
        std::max(angle_rad,
                 Eigen::Quaterniond(T->linear()).angularDistance(Eigen::Quaterniond(v[3], v[4], v[5], v[6])));
    ++poses;
  }
  EXPECT_EQ(poses, 201);
  // Linear interpolation over 20 ms and 10 ms of a curved path.
  EXPECT_LT(position_m, 1e-4);
  EXPECT_LT(angle_rad, 1e-4);
}

TEST_F(FlightRecorderTest, LidarPointsLandOnTheTrueDepth) {
  record(config({"sensors.noise=off"}));
  const Trajectory trajectory = read_poses(bag_path());
  const RectifiedRig rig = StereoRectifier(load_rig(truth_path() / "rig.yaml")).rig();
  const std::int64_t t_image_ns = kStart_ns + 513'000'000;
  const cv::Mat depth_m =
      decode_depth(cv::imread((truth_path() / "depth" / (std::to_string(t_image_ns) + ".png")).string(), -1));
  ASSERT_EQ(depth_m.size(), rig.intrinsics.size());
  const Eigen::Isometry3d T_camera_world = rig.T_camera_imu * trajectory.T_world_imu(t_image_ns)->inverse();
  std::vector<double> errors_m;
  for (const auto& [t_bag_ns, packet] : read<livox_ros_driver::CustomMsg>(bag_path(), kLidarTopic)) {
    for (const livox_ros_driver::CustomPoint& point : packet.points) {
      const Eigen::Vector3d p_lidar(point.x, point.y, point.z);
      const auto T_world_imu = trajectory.T_world_imu(stamp_ns(packet) + point.offset_time);
      if (p_lidar.isZero() || !T_world_imu) continue;
      const Eigen::Vector3d p_camera =
          T_camera_world * *T_world_imu * rig.T_camera_imu.inverse() * rig.T_camera_lidar * p_lidar;
      const Eigen::Vector2d pixel = rig.intrinsics.project(p_camera);
      if (!rig.intrinsics.contains(pixel.x(), pixel.y())) continue;
      const float true_m = depth_m.at<float>(static_cast<int>(std::lround(pixel.y())),
                                             static_cast<int>(std::lround(pixel.x())));
      errors_m.push_back(std::abs(static_cast<double>(true_m) - p_camera.z()));
    }
  }
  ASSERT_GT(errors_m.size(), 50'000U);
  std::sort(errors_m.begin(), errors_m.end());
  // At 20 m a pixel of this camera is 18 cm wide: on sloping ground and at plants the pixel's centre ray
  // meets another depth than the point.
  EXPECT_LT(errors_m[errors_m.size() / 2], 0.01);
  EXPECT_LT(errors_m[errors_m.size() * 9 / 10], 0.10);
}

TEST_F(FlightRecorderTest, RawImagesAreTheOtherFormat) {
  record(config({"sensors.camera.format=raw", "recorder.truth=false", "flights.0.plan.duration_s=0.2"}));
  const auto images = read<sensor_msgs::Image>(bag_path(), "/mynteye/left/image_raw");
  ASSERT_FALSE(images.empty());
  const sensor_msgs::Image& image = images.front().second;
  EXPECT_EQ(image.encoding, "bgr8");
  EXPECT_EQ(image.width, 160U);
  EXPECT_EQ(image.height, 100U);
  EXPECT_EQ(image.data.size(), 160U * 100U * 3U);
  EXPECT_FALSE(fs::exists(truth_path()));
}

TEST_F(FlightRecorderTest, OverwritesNothingAndLeavesNothingBehind) {
  const SimConfig c = config({"flights.0.plan.duration_s=0.2"});
  record(c);
  const std::string before = alight::test::file_text(bag_path());
  EXPECT_THROW(FlightRecorder(c, folder_ / "out").refuse_existing(), DataError);
  EXPECT_THROW(record(c), DataError);
  fs::remove_all(truth_path());
  EXPECT_THROW(record(c), DataError);
  EXPECT_EQ(alight::test::file_text(bag_path()), before);
  for (const auto& entry : fs::directory_iterator(folder_ / "out")) {
    EXPECT_EQ(entry.path().filename(), "quick.bag");
  }
}

TEST_F(FlightRecorderTest, RefusesRigsThatItCannotFly) {
  Rig rig = small_rig();
  rig.cam0.camera.distortion_model = DistortionModel::kRadtan;
  rig.cam0.camera.distortion_coeffs = {0.1, 0, 0, 0};
  EXPECT_THROW(flyable_rig(rig, "rig.yaml"), ConfigError);
  rig = small_rig();
  rig.lidar0.reset();
  EXPECT_THROW(flyable_rig(rig, "rig.yaml"), ConfigError);
  rig = small_rig();
  rig.cam1.reset();
  EXPECT_THROW(flyable_rig(rig, "rig.yaml"), ConfigError);
}

TEST_F(FlightRecorderTest, RosOwnPythonReadsTheBag) {
  if (!alight::test::python_has("rosbag")) GTEST_SKIP() << "Debian's python3-rosbag is not installed";
  record(config({"flights.0.plan.duration_s=0.4", "recorder.compression=lz4"}));
  const fs::path script = folder_ / "read.py";
  std::ofstream(script) << R"(
import sys, rosbag
bag = rosbag.Bag(sys.argv[1])
info = bag.get_type_and_topic_info()
assert info.msg_types['livox_ros_driver/CustomMsg'] == 'e4d6829bdfe657cb6c21a746c86b21a6', info.msg_types
points = 0
for topic, message, t in bag.read_messages():
    if message._type != 'livox_ros_driver/CustomMsg':
        continue
    # The class is generated from the definition text in the bag: its own checksum proves that text.
    assert message._md5sum == 'e4d6829bdfe657cb6c21a746c86b21a6', message._md5sum
    assert message.timebase == message.header.stamp.to_nsec()
    assert message.point_num == len(message.points) == 10000
    assert message.points[7].offset_time == 70000
    points += sum(1 for p in message.points if p.x > 5)
print(points)
)";
  const alight::test::CommandRun read =
      alight::test::run_command("/usr/bin/python3 " + script.string() + " " + bag_path().string());
  ASSERT_EQ(read.exit_code, 0) << read.out;
  EXPECT_GT(std::stoi(read.out), 20'000);
}

TEST(MessageSchedule, PosesEncloseImagesAndShots) {
  const SensorsConfig config;
  std::int64_t last_image_ns = 0;
  std::int64_t last_shot_ns = 0;
  std::map<SensorStream, std::int64_t> last_pose_ns;
  std::int64_t received_ns = 0;
  for (const ScheduledMessage& message : message_schedule(config, 1.37)) {
    EXPECT_GE(message.receive_ns, received_ns);
    EXPECT_GT(message.receive_ns, message.measured_ns);
    received_ns = message.receive_ns;
    if (message.stream == SensorStream::kCamera) {
      last_image_ns = message.measured_ns;
    } else if (message.stream == SensorStream::kLidar) {
      last_shot_ns = message.measured_ns + to_nanoseconds(config.lidar.packet_s) - kLivoxShotPeriod_ns;
    } else {
      last_pose_ns[message.stream] = message.measured_ns;
    }
  }
  EXPECT_LE(std::max(last_image_ns, last_shot_ns), last_pose_ns.at(SensorStream::kAttitude));
  EXPECT_LE(std::max(last_image_ns, last_shot_ns), last_pose_ns.at(SensorStream::kPosition));
}

TEST(SimConfig, ShippedFilesLoad) {
  for (const char* name : {"demo.yaml", "quick.yaml"}) {
    const fs::path path = fs::path(ALIGHT_SOURCE_DIR) / "configs/sim" / name;
    const auto config = load_config<SimConfig>(path);
    EXPECT_EQ(print_config(parse_config<SimConfig>(print_config(config), "printed")), print_config(config));
  }
}

TEST(SimConfig, RefusesFlightsThatWouldShareFiles) {
  const std::string text = "flights:\n  - name: a\n  - name: a\n";
  EXPECT_THAT([&] { parse_config<SimConfig>(text, "x.yaml"); },
              testing::ThrowsMessage<ConfigError>(testing::HasSubstr("same name")));
  EXPECT_THROW(parse_config<SimConfig>("flights:\n  - name: ../a\n", "x.yaml"), ConfigError);
  EXPECT_THROW(parse_config<SimConfig>("flights: []\n", "x.yaml"), ConfigError);
}

}  // namespace
}  // namespace alight::sim
