#include "tests/sensors/test_flight.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <opencv2/imgcodecs.hpp>

#include "geometry/frames.hpp"
#include "tests/support/file_text.hpp"

namespace alight::testing {
namespace fs = std::filesystem;

Rig small_rig() {
  Rig rig;
  rig.cam0.camera.intrinsics = {44, 44, 31.5, 23.5, 64, 48};
  rig.cam0.topic = "/left";
  Eigen::Isometry3d T_camera_imu = Eigen::Isometry3d::Identity();
  T_camera_imu.linear() << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  T_camera_imu.translation() << 0.04, 0.10, -0.12;
  rig.cam0.T_camera_imu = T_camera_imu;
  rig.cam1 = rig.cam0;
  rig.cam1->topic = "/right";
  rig.T_cam1_cam0.translation() << -0.08, 0, 0;
  RigLidar lidar;
  lidar.T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  lidar.T_camera_lidar.translation() << 0.04, 0.09, -0.03;
  lidar.topic = "/livox/lidar";
  rig.lidar0 = lidar;
  return rig;
}

Rig small_mono_rig() {
  Rig rig = small_rig();
  rig.cam1.reset();
  return rig;
}

ros::Time ros_time(std::int64_t t_ns) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(t_ns));
  return time;
}

std_msgs::Header header_at(std::int64_t t_ns) {
  std_msgs::Header header;
  header.stamp = ros_time(t_ns);
  header.frame_id = "frame";
  return header;
}

sensor_msgs::Image image_message(std::int64_t t_ns, int width, int height, const std::string& encoding) {
  sensor_msgs::Image message;
  message.header = header_at(t_ns);
  message.width = static_cast<std::uint32_t>(width);
  message.height = static_cast<std::uint32_t>(height);
  message.encoding = encoding;
  const bool colour = encoding == "rgb8" || encoding == "bgr8";
  message.step = message.width * (colour ? 3u : 1u);
  message.data.resize(std::size_t{message.step} * message.height);
  for (std::size_t i = 0; i < message.data.size(); ++i)
    message.data[i] = static_cast<std::uint8_t>(i * 7 % 251);
  return message;
}

livox_ros_driver::CustomMsg livox_message(std::int64_t t_ns, int points) {
  livox_ros_driver::CustomMsg message;
  message.header = header_at(t_ns);
  message.timebase = static_cast<std::uint64_t>(t_ns);
  message.point_num = static_cast<std::uint32_t>(points);
  message.points.resize(static_cast<std::size_t>(points));
  for (int i = 0; i < points; ++i) {
    auto& point = message.points[static_cast<std::size_t>(i)];
    point.offset_time = static_cast<std::uint32_t>(i * (100'000'000 / std::max(points, 1)));
    point.x = 10.0F;
    point.y = 3.0F * std::sin(static_cast<float>(i) * 2.4F);
    point.z = 3.0F * std::cos(static_cast<float>(i) * 1.7F);
    point.reflectivity = static_cast<std::uint8_t>(i % 256);
  }
  return message;
}

geometry_msgs::QuaternionStamped attitude_message(std::int64_t t_ns) {
  geometry_msgs::QuaternionStamped message;
  message.header = header_at(t_ns);
  message.quaternion.w = 1;
  return message;
}

sensor_msgs::NavSatFix fix_message(std::int64_t t_ns, const Eigen::Vector3d& p_world) {
  static const LocalEnu enu(31.3, 121.5, 20.0);
  const Eigen::Vector3d geodetic = enu.to_geodetic(p_world);
  sensor_msgs::NavSatFix message;
  message.header = header_at(t_ns);
  message.latitude = geodetic.x();
  message.longitude = geodetic.y();
  message.altitude = geodetic.z();
  return message;
}

std_msgs::Float32 float_message(float value) {
  std_msgs::Float32 message;
  message.data = value;
  return message;
}

geometry_msgs::PoseStamped pose_message(std::int64_t t_ns) {
  geometry_msgs::PoseStamped message;
  message.header = header_at(t_ns);
  message.header.frame_id = "world";
  message.pose.position.x = 1;
  message.pose.position.y = 2;
  message.pose.position.z = 3;
  message.pose.orientation.w = message.pose.orientation.z = std::sqrt(0.5);
  return message;
}

nav_msgs::Odometry odometry_message(std::int64_t t_ns) {
  const geometry_msgs::PoseStamped pose = pose_message(t_ns);
  nav_msgs::Odometry message;
  message.header = pose.header;
  message.child_frame_id = "body";
  message.pose.pose = pose.pose;
  return message;
}

geometry_msgs::TransformStamped transform_message(std::int64_t t_ns) {
  const geometry_msgs::PoseStamped pose = pose_message(t_ns);
  geometry_msgs::TransformStamped message;
  message.header = pose.header;
  message.child_frame_id = "body";
  message.transform.translation.x = pose.pose.position.x;
  message.transform.translation.y = pose.pose.position.y;
  message.transform.translation.z = pose.pose.position.z;
  message.transform.rotation = pose.pose.orientation;
  return message;
}

tf2_msgs::TFMessage tf_message(std::int64_t t_ns) {
  geometry_msgs::TransformStamped other = transform_message(t_ns);
  other.child_frame_id = "lidar";
  other.transform.translation.x = 7;
  tf2_msgs::TFMessage message;
  message.transforms = {other, transform_message(t_ns), other};
  return message;
}

sensor_msgs::CameraInfo camera_info_message(std::int64_t t_ns) {
  sensor_msgs::CameraInfo message;
  message.header = header_at(t_ns);
  message.width = 64;
  message.height = 48;
  message.distortion_model = "plumb_bob";
  message.D = {0.1, -0.02, 0.003, -0.004, 0.005};
  message.K = {44, 0, 31.5, 0, 45, 23.5, 0, 0, 1};
  return message;
}

namespace {

sensor_msgs::CompressedImage compress(const sensor_msgs::Image& image) {
  const cv::Mat pixels(static_cast<int>(image.height), static_cast<int>(image.width), CV_8UC3,
                       const_cast<std::uint8_t*>(image.data.data()));
  sensor_msgs::CompressedImage message;
  message.header = image.header;
  message.format = "bgr8; jpeg compressed bgr8";
  cv::imencode(".jpg", pixels, message.data);
  return message;
}

}  // namespace

void write_flight(const fs::path& path, const FlightOptions& options) {
  rosbag::Bag bag(path.string(), rosbag::bagmode::Write);
  const auto wanted = [&](const std::string& topic) {
    return std::find(options.left_out.begin(), options.left_out.end(), topic) == options.left_out.end();
  };
  const auto write = [&](const std::string& topic, std::int64_t t_ns, const auto& message) {
    if (wanted(topic)) bag.write(topic, ros_time(t_ns), message);
  };
  const auto write_camera = [&](const std::string& topic, std::int64_t t_ns) {
    const sensor_msgs::Image image = image_message(t_ns, 64, 48, "bgr8");
    if (options.compressed) return write(topic + "/compressed", t_ns, compress(image));
    write(topic, t_ns, image);
  };
  for (std::int64_t ms = 0; ms < static_cast<std::int64_t>(options.duration_s * 1000); ms += 10) {
    const std::int64_t t_ns = kStart_ns + ms * 1'000'000;
    write("/dji_sdk/attitude", t_ns, attitude_message(t_ns));
    if (ms % 20 == 0) write("/dji_sdk/gps_position", t_ns, fix_message(t_ns));
    if (ms % 20 == 0) write("/dji_sdk/height_above_takeoff", t_ns, float_message(10.0F));
    if (ms % 100 != 50) continue;
    write_camera("/left", t_ns);
    if (options.right) write_camera("/right", t_ns);
    write("/livox/lidar", t_ns, livox_message(t_ns - 100'000'000, 500));
  }
  bag.close();
}

std::vector<LogMessage> read_all(FlightLog& log) {
  std::vector<LogMessage> messages;
  LogMessage message;
  while (log.next(message)) messages.push_back(std::move(message));
  return messages;
}

std::vector<std::pair<std::string, std::string>> read_tree(const fs::path& dir) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const auto& entry : fs::recursive_directory_iterator(dir)) {
    if (entry.is_regular_file())
      files.emplace_back(fs::relative(entry.path(), dir).string(), test::file_text(entry.path()));
  }
  std::sort(files.begin(), files.end());
  return files;
}

void write_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace alight::testing
