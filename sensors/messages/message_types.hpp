#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "geometry/camera.hpp"

/// What a log or a live topic delivers once its ROS type is decoded. Times are on the IMU's clock (time
/// shifts applied), int64 nanoseconds. The message types of ROS stop at the decoders: nothing behind them
/// sees one.
namespace alight {

/// One image of one camera: CV_8UC1 grey or CV_8UC3 BGR.
struct CameraImage {
  std::int64_t t_ns = 0;
  cv::Mat image;
};

struct UndecodedFrame;

/// Both cameras of one exposure, raw as in the log (not rectified), grey or BGR. `right` is empty for a mono
/// rig.
struct StereoFrame {
  std::int64_t t_ns = 0;  ///< exposure of the left image
  cv::Mat left;
  cv::Mat right;
  std::shared_ptr<const UndecodedFrame> undecoded =
      nullptr;  ///< where decoding was put off; the images are then empty
};

/// One echo, at its own time.
struct LidarReturn {
  std::int64_t t_ns = 0;
  Eigen::Vector3f p_lidar = Eigen::Vector3f::Zero();  ///< metres
  std::uint8_t reflectivity = 0;
};

/// The returns of one LiDAR message, in the message's order.
struct LidarPacket {
  std::int64_t t_ns = 0;  ///< the message's stamp
  std::vector<LidarReturn> returns;
  std::int64_t dropped = 0;       ///< points without echo, not finite or out of range; not in `returns`
  std::int64_t noise = 0;         ///< points that the sensor marked as noise; not in `returns`
  std::string frame_id{};         ///< of the message's header
  std::optional<int> lidar_id{};  ///< where the message tells which of a driver's LiDARs it is from
};

/// Attitude of the vehicle's body (x forward, y left, z up) in East-North-Up, unit length.
struct AttitudeSample {
  std::int64_t t_ns = 0;
  Eigen::Quaterniond q_world_imu = Eigen::Quaterniond::Identity();
  std::optional<double> rate_rad_s{};  ///< of turning, by the same message's gyroscope
};

/// A satellite fix, WGS84.
struct GeodeticPosition {
  double latitude_deg = 0;
  double longitude_deg = 0;
  double altitude_m = 0;  ///< above the ellipsoid
  double sigma_m = 0;     ///< 1 sigma horizontally, as the receiver says; 0: it does not
};

/// Where the vehicle is: a satellite fix, or metres in the upright frame of an odometry, a tracker or a total station.
/// WorldFrame makes either a position in `world`.
struct PositionSample {
  std::int64_t t_ns = 0;
  std::variant<GeodeticPosition, Eigen::Vector3d> position;
};

/// Height above the take-off place.
struct HeightSample {
  std::int64_t t_ns = 0;
  double height_m = 0;
};

/// A lens as its driver describes it (not a measurement: no log message is made of it).
struct CameraDescription {
  std::int64_t t_ns = 0;
  Camera camera;
};

/// What a decoder makes of one message.
using DecodedMessage =
    std::variant<CameraImage, LidarPacket, AttitudeSample, PositionSample, HeightSample, CameraDescription>;

/// What a log delivers: as decoded, with the two cameras paired.
using LogMessage = std::variant<StereoFrame, LidarPacket, AttitudeSample, PositionSample, HeightSample>;

}  // namespace alight
