#pragma once

#include <cstdint>
#include <string>

#include <geometry_msgs/QuaternionStamped.h>
#include <opencv2/core.hpp>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>
#include <std_msgs/Float32.h>

#include "sensors/messages/livox_custom_msg.hpp"
#include "sim/sensors/lidar_sensor.hpp"
#include "sim/sensors/pose_sensors.hpp"

/// The simulated sensors' measurements as the ROS messages of the paper's rig. `stamp_ns` is on the sensor's
/// own clock, `sequence` the message's number.
namespace alight::sim {

/// Nanoseconds as ROS writes them.
ros::Time to_ros_time(std::int64_t t_ns);

/// The messages of the paper's rig (docs/formats.md), stamps in nanoseconds, angles as quaternions, heights in metres.
geometry_msgs::QuaternionStamped attitude_message(const Eigen::Quaterniond& q_world_imu,
                                                  std::int64_t stamp_ns, std::uint32_t sequence);
sensor_msgs::Imu imu_message(const ImuSample& sample, std::int64_t stamp_ns, std::uint32_t sequence);
sensor_msgs::NavSatFix position_message(const GeodeticFix& fix, std::int64_t stamp_ns,
                                        std::uint32_t sequence);
std_msgs::Float32 height_message(double height_m);

/// Time base and stamp are the first shot's time.
livox_ros_driver::CustomMsg lidar_message(const LidarScan& scan, std::int64_t stamp_ns,
                                          std::uint32_t sequence);

/// @param image CV_8UC3 BGR
sensor_msgs::Image image_message(const cv::Mat& image, const std::string& frame, std::int64_t stamp_ns,
                                 std::uint32_t sequence);
sensor_msgs::CompressedImage jpeg_message(const cv::Mat& image, int quality, const std::string& frame,
                                          std::int64_t stamp_ns, std::uint32_t sequence);

}  // namespace alight::sim
