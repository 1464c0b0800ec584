#include "infer/replay/stage_benchmark.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr std::int64_t kImagePeriod_ns = 50'000'000;
constexpr std::int64_t kLidarPeriod_ns = 100'000'000;
constexpr std::int64_t kPosePeriod_ns = 10'000'000;
constexpr int kPointsPerPacket = 10'000;
constexpr double kLidarHalfFov_rad = 19.0 * kRadiansPerDegree;

cv::Mat texture(cv::Size size) {
  cv::Mat noise(size, CV_8UC3);
  cv::RNG random(1);
  random.fill(noise, cv::RNG::UNIFORM, 40, 216);
  cv::GaussianBlur(noise, noise, {5, 5}, 1.2);
  return noise;
}

StereoFrame stereo_frame(const Rig& rig, const cv::Mat& ground, double height_m, std::int64_t t_ns) {
  const PinholeIntrinsics& k = rig.cam0.camera.intrinsics;
  const double disparity_px = k.fx_px * rig.T_cam1_cam0.translation().norm() / height_m;
  StereoFrame frame;
  frame.t_ns = t_ns;
  frame.left = ground(cv::Rect({0, 0}, k.size())).clone();
  if (rig.cam1) {
    const cv::Matx23d shift(1, 0, disparity_px, 0, 1, 0);
    cv::warpAffine(ground, frame.right, shift, k.size(), cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  }
  return frame;
}

LidarPacket lidar_packet(double height_m, std::int64_t end_ns, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  LidarPacket packet;
  packet.t_ns = end_ns - kLidarPeriod_ns;
  packet.returns.reserve(kPointsPerPacket);
  for (int i = 0; i < kPointsPerPacket; ++i) {
    const double angle = 2 * kRadiansPerDegree * 180.0 * uniform(random);
    const double away = std::tan(kLidarHalfFov_rad) * std::sqrt(uniform(random));
    LidarReturn echo;
    echo.t_ns = packet.t_ns + (i + 1) * (kLidarPeriod_ns / kPointsPerPacket);
    echo.p_lidar =
        (height_m * Eigen::Vector3d(1, away * std::cos(angle), away * std::sin(angle))).cast<float>();
    packet.returns.push_back(echo);
  }
  return packet;
}

}  // namespace

std::vector<LogMessage> synthetic_hover(const Rig& rig, double height_m, double duration_s) {
  const PinholeIntrinsics& k = rig.cam0.camera.intrinsics;
  const cv::Mat ground = texture({k.width_px + 256, k.height_px});
  // Camera straight down: the IMU's attitude follows from the mounting.
  Eigen::Matrix3d R_world_camera;
  R_world_camera << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  const Eigen::Isometry3d T_camera_imu = rig.cam0.T_camera_imu.value_or(Eigen::Isometry3d::Identity());
  const Eigen::Quaterniond q_world_imu(Eigen::Matrix3d(R_world_camera * T_camera_imu.linear()));
  std::mt19937 random(2);
  std::vector<LogMessage> messages;
  const std::int64_t end_ns = to_nanoseconds(duration_s);
  for (std::int64_t t_ns = 0; t_ns <= end_ns; t_ns += kPosePeriod_ns) {
    messages.push_back(AttitudeSample{t_ns, q_world_imu});
    if (t_ns % (2 * kPosePeriod_ns) == 0)
      messages.push_back(PositionSample{t_ns, GeodeticPosition{22.3, 114.2, height_m}});
    if (t_ns > 0 && t_ns % kImagePeriod_ns == 0)
      messages.push_back(stereo_frame(rig, ground, height_m, t_ns));
    if (t_ns > 0 && t_ns % kLidarPeriod_ns == 0) messages.push_back(lidar_packet(height_m, t_ns, random));
  }
  return messages;
}

}  // namespace alight
