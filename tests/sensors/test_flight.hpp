#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/QuaternionStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>
#include <std_msgs/Float32.h>
#include <tf2_msgs/TFMessage.h>

#include "geometry/geodesy.hpp"
#include "sensors/messages/livox_custom_msg.hpp"
#include "sensors/stream/flight_log.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight::testing {

using test::ScratchFolder;

/// The message of the exception that `body` throws; empty if it throws none of this type.
template <class Error>
std::string message_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

/// Down-looking stereo of 64x48 pixels, already rectified, and a LiDAR; the paper's rig, small.
Rig small_rig();
/// The same without a right camera.
Rig small_mono_rig();

/// Times of the test flights: far from zero, like real ones.
constexpr std::int64_t kStart_ns = 1'600'000'000'000'000'000;
ros::Time ros_time(std::int64_t t_ns);
std_msgs::Header header_at(std::int64_t t_ns);

sensor_msgs::Image image_message(std::int64_t t_ns, int width, int height, const std::string& encoding);
livox_ros_driver::CustomMsg livox_message(std::int64_t t_ns, int points);
geometry_msgs::QuaternionStamped attitude_message(std::int64_t t_ns);
sensor_msgs::NavSatFix fix_message(std::int64_t t_ns,
                                   const Eigen::Vector3d& p_world = Eigen::Vector3d::Zero());
std_msgs::Float32 float_message(float value);
/// Turned by 90 deg to the left at (1, 2, 3); of `body` in `world`.
geometry_msgs::PoseStamped pose_message(std::int64_t t_ns);
nav_msgs::Odometry odometry_message(std::int64_t t_ns);
geometry_msgs::TransformStamped transform_message(std::int64_t t_ns);
/// Between two others of other frames.
tf2_msgs::TFMessage tf_message(std::int64_t t_ns);
/// 64x48 pixels with plumb_bob distortion.
sensor_msgs::CameraInfo camera_info_message(std::int64_t t_ns);

/// What a test may change of the flight that write_flight writes.
struct FlightOptions {
  double duration_s = 3;
  bool right = true;
  bool compressed = false;
  std::vector<std::string> left_out;  ///< topics
};
/// A short hover over level ground 10 m below: images at 10 Hz, LiDAR 10 Hz, attitude 100 Hz, fixes 50 Hz,
/// heights.
void write_flight(const std::filesystem::path& path, const FlightOptions& options = {});

std::vector<LogMessage> read_all(FlightLog& log);

/// The bytes of all files below a folder, by relative path.
std::vector<std::pair<std::string, std::string>> read_tree(const std::filesystem::path& dir);
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

}  // namespace alight::testing
