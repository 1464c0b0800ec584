#include "sim/record/sensor_messages.hpp"

#include <stdexcept>

#include <opencv2/imgcodecs.hpp>

#include "geometry/frames.hpp"
#include "sim/sensors/livox_scan.hpp"

namespace alight::sim {
namespace {

std_msgs::Header header(const std::string& frame, std::int64_t stamp_ns, std::uint32_t sequence) {
  std_msgs::Header result;
  result.frame_id = frame;
  result.stamp = to_ros_time(stamp_ns);
  result.seq = sequence;
  return result;
}

geometry_msgs::Quaternion to_message(const Eigen::Quaterniond& q) {
  geometry_msgs::Quaternion message;
  message.w = q.w();
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  return message;
}

geometry_msgs::Vector3 to_message(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

}  // namespace

ros::Time to_ros_time(std::int64_t t_ns) {
  return {static_cast<std::uint32_t>(t_ns / kNanosecondsPerSecond),
          static_cast<std::uint32_t>(t_ns % kNanosecondsPerSecond)};
}

geometry_msgs::QuaternionStamped attitude_message(const Eigen::Quaterniond& q_world_imu,
                                                  std::int64_t stamp_ns, std::uint32_t sequence) {
  geometry_msgs::QuaternionStamped message;
  message.header = header("body_FLU", stamp_ns, sequence);
  message.quaternion = to_message(q_world_imu);
  return message;
}

sensor_msgs::Imu imu_message(const ImuSample& sample, std::int64_t stamp_ns, std::uint32_t sequence) {
  sensor_msgs::Imu message;
  message.header = header("body_FLU", stamp_ns, sequence);
  message.orientation = to_message(sample.q_world_imu);
  message.angular_velocity = to_message(sample.angular_velocity_radps);
  message.linear_acceleration = to_message(sample.specific_force_mps2);
  return message;
}

sensor_msgs::NavSatFix position_message(const GeodeticFix& fix, std::int64_t stamp_ns,
                                        std::uint32_t sequence) {
  sensor_msgs::NavSatFix message;
  message.header = header("gps", stamp_ns, sequence);
  message.status.status = sensor_msgs::NavSatStatus::STATUS_FIX;
  message.status.service = sensor_msgs::NavSatStatus::SERVICE_GPS;
  message.latitude = fix.latitude_deg;
  message.longitude = fix.longitude_deg;
  message.altitude = fix.altitude_m;
  message.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_UNKNOWN;
  return message;
}

std_msgs::Float32 height_message(double height_m) {
  std_msgs::Float32 message;
  message.data = static_cast<float>(height_m);
  return message;
}

livox_ros_driver::CustomMsg lidar_message(const LidarScan& scan, std::int64_t stamp_ns,
                                          std::uint32_t sequence) {
  livox_ros_driver::CustomMsg message;
  message.header = header("livox_frame", stamp_ns, sequence);
  message.timebase = static_cast<std::uint64_t>(stamp_ns);
  message.point_num = static_cast<std::uint32_t>(scan.shots.size());
  message.points.resize(scan.shots.size());
  for (std::size_t i = 0; i < scan.shots.size(); ++i) {
    livox_ros_driver::CustomPoint& point = message.points[i];
    point.offset_time = static_cast<std::uint32_t>(static_cast<std::int64_t>(i) * kLivoxShotPeriod_ns);
    point.x = scan.shots[i].p_lidar.x();
    point.y = scan.shots[i].p_lidar.y();
    point.z = scan.shots[i].p_lidar.z();
    point.reflectivity = scan.shots[i].reflectivity;
  }
  return message;
}

sensor_msgs::Image image_message(const cv::Mat& image, const std::string& frame, std::int64_t stamp_ns,
                                 std::uint32_t sequence) {
  sensor_msgs::Image message;
  message.header = header(frame, stamp_ns, sequence);
  message.height = static_cast<std::uint32_t>(image.rows);
  message.width = static_cast<std::uint32_t>(image.cols);
  message.encoding = "bgr8";
  message.is_bigendian = 0;
  const std::size_t row_bytes = static_cast<std::size_t>(image.cols) * image.elemSize();
  message.step = static_cast<std::uint32_t>(row_bytes);
  message.data.reserve(row_bytes * static_cast<std::size_t>(image.rows));
  for (int v = 0; v < image.rows; ++v) {
    message.data.insert(message.data.end(), image.ptr(v), image.ptr(v) + row_bytes);
  }
  return message;
}

sensor_msgs::CompressedImage jpeg_message(const cv::Mat& image, int quality, const std::string& frame,
                                          std::int64_t stamp_ns, std::uint32_t sequence) {
  sensor_msgs::CompressedImage message;
  message.header = header(frame, stamp_ns, sequence);
  message.format = "bgr8; jpeg compressed bgr8";  // what ROS's compressed_image_transport writes
  if (!cv::imencode(".jpg", image, message.data, {cv::IMWRITE_JPEG_QUALITY, quality})) {
    throw std::runtime_error("an image cannot be encoded as JPEG");
  }
  return message;
}

}  // namespace alight::sim
