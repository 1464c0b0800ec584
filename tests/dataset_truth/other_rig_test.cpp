#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>

#include <geometry_msgs/QuaternionStamped.h>
#include <nav_msgs/Odometry.h>
#include <opencv2/imgcodecs.hpp>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <gtest/gtest.h>

#include "dataset/build/dataset_builder.hpp"
#include "foundation/config_reader.hpp"
#include "geometry/rig/find_rig_file.hpp"
#include "sensors/messages/livox_custom_msg.hpp"
#include "sensors/poses/flight_trajectory.hpp"
#include "sensors/stream/flight_log.hpp"
#include "sim/record/simulated_log.hpp"
#include "tests/support/scratch_folder.hpp"

/// One simulated flight as two vehicles would record it: the paper's, and one with other messages, topics, clocks and
/// ways to write its calibration down. Two configurations read the same depth maps out of both.
namespace alight {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLidarClockLate_ns = 40'000'000;

/// The other vehicle's rig: mounting of each sensor to the IMU rather than to the camera, in millimetres and as inverses.
constexpr const char* kOtherRig = R"(cam0:
  camera_model: pinhole
  intrinsics: [440, 440, 319.5, 199.5]
  resolution: [640, 400]
  T_imu_cam: {xyz: [100, 40, -120], rotation: [0, -1, 0, -1, 0, 0, 0, 0, -1], length_unit: mm}
  rostopic: /front/colour
lidar0:
  T_lidar_imu: {xyz: [-90, 0, -10], quaternion_xyzw: [0, -0.7071067811865476, 0, 0.7071067811865476], length_unit: mm}
  timeshift: -0.04
  stamp_at: end
  rostopic: /cloud
)";
constexpr const char* kOtherConfig = R"(rig: other_rig.yaml
log:
  attitude_topic: /odometry
  position_topic: /odometry
  height_topic: none
depth_map:
  every_nth_image: 1
)";
const std::string kPaperConfig =
    "rig: " ALIGHT_SOURCE_DIR "/configs/rigs/paper.yaml\ndepth_map:\n  every_nth_image: 1\n";

sensor_msgs::CompressedImage jpeg(const sensor_msgs::Image& image) {
  const cv::Mat pixels(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC3,
                       const_cast<std::uint8_t*>(image.data.data()), image.step);
  sensor_msgs::CompressedImage message;
  message.header = image.header;
  message.format = "jpeg";
  cv::imencode(".jpg", pixels, message.data, {cv::IMWRITE_JPEG_QUALITY, 95});
  return message;
}

void add_field(sensor_msgs::PointCloud2& cloud, const std::string& name, std::uint8_t type,
               std::uint32_t offset) {
  sensor_msgs::PointField field;
  field.name = name;
  field.datatype = type;
  field.offset = offset;
  field.count = 1;
  cloud.fields.push_back(field);
}

/// Time first, the stamp at the end of the packet, on a clock that is late.
sensor_msgs::PointCloud2 cloud(const livox_ros_driver::CustomMsg& livox) {
  sensor_msgs::PointCloud2 message;
  message.header = livox.header;
  std::uint32_t longest_ns = 0;
  for (const auto& point : livox.points) longest_ns = std::max(longest_ns, point.offset_time);
  message.header.stamp.fromNSec(livox.header.stamp.toNSec() + longest_ns + kLidarClockLate_ns);
  message.height = 1;
  message.width = livox.point_num;
  message.point_step = 21;
  message.row_step = message.width * message.point_step;
  add_field(message, "offset_time", sensor_msgs::PointField::UINT32, 0);
  add_field(message, "reflectivity", sensor_msgs::PointField::UINT8, 4);
  add_field(message, "x", sensor_msgs::PointField::FLOAT32, 5);
  add_field(message, "y", sensor_msgs::PointField::FLOAT32, 9);
  add_field(message, "z", sensor_msgs::PointField::FLOAT32, 13);
  message.data.resize(std::size_t{message.row_step});
  std::uint8_t* at = message.data.data();
  for (const auto& point : livox.points) {
    std::memcpy(at, &point.offset_time, 4);
    at[4] = point.reflectivity;
    std::memcpy(at + 5, &point.x, 4);
    std::memcpy(at + 9, &point.y, 4);
    std::memcpy(at + 13, &point.z, 4);
    at += message.point_step;
  }
  return message;
}

/// The pose at the attitude's times, in metres of a frame of its own.
nav_msgs::Odometry odometry(const Eigen::Isometry3d& T_world_imu, const std_msgs::Header& header) {
  const Eigen::Quaterniond q(T_world_imu.linear());
  nav_msgs::Odometry message;
  message.header = header;
  message.pose.pose.position.x = T_world_imu.translation().x();
  message.pose.pose.position.y = T_world_imu.translation().y();
  message.pose.pose.position.z = T_world_imu.translation().z();
  message.pose.pose.orientation.x = q.x();
  message.pose.pose.orientation.y = q.y();
  message.pose.pose.orientation.z = q.z();
  message.pose.pose.orientation.w = q.w();
  return message;
}

/// The whole flight's poses, as the messages say.
FlightTrajectory trajectory_of(const fs::path& log, const Rig& rig) {
  FlightTrajectory trajectory(0.25);
  FlightLog reader(log, rig, {});
  LogMessage message;
  while (reader.next(message)) {
    if (const auto* attitude = std::get_if<AttitudeSample>(&message)) trajectory.add(*attitude);
    if (const auto* position = std::get_if<PositionSample>(&message)) trajectory.add(*position);
  }
  return trajectory;
}

/// The paper's vehicle's bag as the other vehicle would have recorded it.
void convert(const fs::path& from, const fs::path& to, const FlightTrajectory& trajectory) {
  rosbag::Bag in(from.string(), rosbag::bagmode::Read);
  rosbag::Bag out(to.string(), rosbag::bagmode::Write);
  for (const rosbag::MessageInstance& message : rosbag::View(in)) {
    if (const auto image = message.instantiate<sensor_msgs::Image>()) {
      const bool left = message.getTopic() == "/mynteye/left/image_raw";
      if (left) out.write("/front/colour/compressed", message.getTime(), jpeg(*image));
    } else if (const auto livox = message.instantiate<livox_ros_driver::CustomMsg>()) {
      out.write("/cloud", message.getTime(), cloud(*livox));
    } else if (const auto attitude = message.instantiate<geometry_msgs::QuaternionStamped>()) {
      const auto T_world_imu =
          trajectory.trajectory().T_world_imu(static_cast<std::int64_t>(attitude->header.stamp.toNSec()));
      if (T_world_imu) out.write("/odometry", message.getTime(), odometry(*T_world_imu, attitude->header));
    }
  }
}

struct Difference {
  std::size_t pixels = 0;     ///< with a depth in either
  std::size_t different = 0;  ///< by more than the step of the format, or in one alone
  double image_rms = 0;
};

void compare(const Sample& a, const Sample& b, Difference& difference) {
  for (int v = 0; v < a.sparse.depth_m.rows; ++v) {
    for (int u = 0; u < a.sparse.depth_m.cols; ++u) {
      const float depth_a_m = a.sparse.depth_m.at<float>(v, u);
      const float depth_b_m = b.sparse.depth_m.at<float>(v, u);
      if (depth_a_m == 0 && depth_b_m == 0) continue;
      ++difference.pixels;
      if (std::abs(depth_a_m - depth_b_m) > 1.01F / 256) ++difference.different;
    }
  }
  const double rms =
      cv::norm(a.left, b.left, cv::NORM_L2) / std::sqrt(static_cast<double>(a.left.total() * 3));
  difference.image_rms = std::max(difference.image_rms, rms);
}

class OtherRig : public ::testing::Test {
 protected:
  fs::path fly() {
    sim::SimConfig config;
    config.rig = (fs::path(ALIGHT_SOURCE_DIR) / "configs" / "rigs" / "paper.yaml").string();
    config.sensors.noise = sim::Noise::kOff;
    config.sensors.camera.rate_hz = 4;
    config.sensors.camera.format = sim::ImageFormat::kRaw;
    sim::FlightConfig flight;
    flight.name = "flight";
    flight.seed = 7;
    flight.world.look = sim::Look::kVillage;
    flight.world.seed = 4;
    flight.world.size_m = 90;
    flight.plan.kind = sim::PlanKind::kStraight;
    flight.plan.speed_mps = 3;
    flight.plan.yaw_rate_deg_per_s = 30;
    flight.plan.start_height_m = 20;
    flight.plan.duration_s = 4;
    sim::FlightRecorder(config, folder_).record(flight);
    return folder_ / "flight.bag";
  }

  /// Builds by a YAML file and the rig that it names.
  DatasetInfo build(const std::string& yaml, const fs::path& log, const fs::path& data) {
    const fs::path file = folder_ / (data.stem().string() + ".yaml");
    std::ofstream(file) << yaml;
    const auto config = load_config<DatasetConfig>(file);
    return build_dataset(config, load_rig(find_rig_file(config.rig, file)), {log}, data).info;
  }

  const test::ScratchFolder scratch_;
  const fs::path folder_ = scratch_.path();
};

TEST_F(OtherRig, OtherMessagesTopicsClocksAndCalibrationFormsGiveTheSameDepthMaps) {
  const fs::path log = fly();
  const fs::path other_log = folder_ / "other" / "flight.bag";
  fs::create_directories(other_log.parent_path());
  std::ofstream(folder_ / "other_rig.yaml") << kOtherRig;
  const Rig paper = load_rig(fs::path(ALIGHT_SOURCE_DIR) / "configs" / "rigs" / "paper.yaml");
  convert(log, other_log, trajectory_of(log, paper));

  const DatasetInfo info = build(kPaperConfig, log, folder_ / "paper");
  const DatasetInfo other = build(kOtherConfig, other_log, folder_ / "mono");
  EXPECT_TRUE(info.rig.T_camera_lidar.isApprox(other.rig.T_camera_lidar, 1e-9));
  EXPECT_FALSE(other.flights.at(0).has_right);
  const auto rows = read_samples(folder_ / "paper", "flight");
  const auto other_rows = read_samples(folder_ / "mono", "flight");
  ASSERT_GE(rows.size(), 8u);
  Difference difference;
  std::size_t compared = 0;
  for (const SampleRow& other_row : other_rows) {
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const SampleRow& r) { return r.t_ns == other_row.t_ns; });
    ASSERT_NE(row, rows.end()) << "an image that the paper's configuration leaves out";
    EXPECT_TRUE(row->T_world_camera.isApprox(other_row.T_world_camera, 1e-6));
    compare(read_sample(folder_ / "paper", info.flights.at(0), *row, false),
            read_sample(folder_ / "mono", other.flights.at(0), other_row, false), difference);
    ++compared;
  }
  std::printf("%zu samples, %zu pixels, %zu different, image RMS %.2f\n", compared, difference.pixels,
              difference.different, difference.image_rms);
  EXPECT_GE(compared + 1, rows.size());  // the first pose may lack its odometry
  EXPECT_GT(difference.pixels, 100'000u);
  EXPECT_LE(static_cast<double>(difference.different), 1e-3 * static_cast<double>(difference.pixels));
  EXPECT_LT(difference.image_rms, 4) << "of 255: what JPEG leaves";
  EXPECT_GT(difference.image_rms, 0);
}

}  // namespace
}  // namespace alight
