#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "geometry/frames.hpp"
#include "geometry/rig/rig.hpp"
#include "infer/depth/depth_predictor.hpp"
#include "sensors/messages/message_types.hpp"

/// A small world with a known answer, as messages.
namespace alight::fakes {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kStart_ns = 1'600'000'000'000'000'000;

/// The paper's geometry with small images: 176x160, f = 220 px.
inline Rig small_rig() {
  Rig rig;
  rig.cam0.camera.intrinsics = {220, 220, 87.5, 79.5, 176, 160};
  Eigen::Isometry3d T_camera_imu = Eigen::Isometry3d::Identity();
  T_camera_imu.linear() << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  rig.cam0.T_camera_imu = T_camera_imu;
  rig.cam0.topic = "/mynteye/left/image_raw";
  rig.cam1 = rig.cam0;
  rig.cam1->topic = "/mynteye/right/image_raw";
  rig.T_cam1_cam0.translation().x() = -0.08;
  rig.lidar0.emplace();
  rig.lidar0->T_camera_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  rig.lidar0->T_camera_lidar.translation() = Eigen::Vector3d(0.04, 0.09, -0.03);
  rig.lidar0->topic = "/livox/lidar";
  return rig;
}

/// Level ground `height_m` below the camera, covered with noise; the right camera sees it moved by the true disparity.
class LevelWorld {
 public:
  explicit LevelWorld(double height_m, std::uint32_t seed = 3) : height_m_(height_m), random_(seed) {
    ground_.create(160, 176 + 64, CV_8UC1);
    cv::RNG noise(seed);
    noise.fill(ground_, cv::RNG::UNIFORM, 30, 226);
    cv::GaussianBlur(ground_, ground_, {3, 3}, 0.7);
  }
  double height_m() const { return height_m_; }
  double disparity_px() const { return 220 * 0.08 / height_m_; }

  StereoFrame frame(std::int64_t t_ns, bool with_right = true) const {
    StereoFrame frame;
    frame.t_ns = t_ns;
    frame.left = view(0);
    if (with_right) frame.right = view(disparity_px());
    return frame;
  }
  /// 0.1 s of LiDAR that ends at `end_ns`: `count` points spread over 17 degrees around straight down.
  LidarPacket packet(std::int64_t end_ns, int count = 2000) {
    LidarPacket packet;
    packet.t_ns = end_ns - 100 * kMillisecond;
    std::uniform_real_distribution<double> uniform(-1, 1);
    const double range_m = height_m_ + 0.03;  // the LiDAR sits 3 cm above the camera
    const double edge = std::tan(to_radians(17));
    for (int i = 0; i < count; ++i) {
      LidarReturn echo;
      echo.t_ns = packet.t_ns + (i + 1) * (100 * kMillisecond / count);
      double y = uniform(random_);
      double z = uniform(random_);
      while (std::hypot(y, z) > 1) y = uniform(random_), z = uniform(random_);
      echo.p_lidar = Eigen::Vector3d(range_m, range_m * edge * y, range_m * edge * z).cast<float>();
      packet.returns.push_back(echo);
    }
    return packet;
  }

 private:
  cv::Mat view(double shift_px) const {
    cv::Mat image;
    const cv::Matx23d move(1, 0, 32 + shift_px, 0, 1, 0);  // output pixel -> ground pixel
    cv::warpAffine(ground_, image, move, {176, 160}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
    return image;
  }

  double height_m_;
  std::mt19937 random_;
  cv::Mat ground_;
};

inline AttitudeSample attitude_at(std::int64_t t_ns) { return {t_ns, Eigen::Quaterniond::Identity()}; }
inline PositionSample position_at(std::int64_t t_ns) { return {t_ns, GeodeticPosition{22.3, 114.2, 50}}; }

/// What flows in a hovering flight.
struct FlightPlan {
  double duration_s = 2.0;
  double image_hz = 20;
  double lidar_begin_s = 0;
  double lidar_end_s = 1e9;
  double pose_begin_s = 0;
  double pose_end_s = 1e9;
  double lidar_delay_s = 0;  ///< between a packet's last point and its arrival
  bool right = true;
};

/// All messages in order of arrival.
inline std::vector<LogMessage> flight(LevelWorld& world, const FlightPlan& plan) {
  std::vector<std::pair<std::int64_t, LogMessage>> messages;
  const auto at = [](double s) { return kStart_ns + to_nanoseconds(s); };
  for (int i = 0; i * 0.01 <= plan.duration_s; ++i) {
    const double t_s = i * 0.01;
    if (t_s < plan.pose_begin_s || t_s > plan.pose_end_s) continue;
    messages.emplace_back(at(t_s), attitude_at(at(t_s)));
    if (i % 2 == 0) messages.emplace_back(at(t_s), position_at(at(t_s)));
  }
  for (int i = 1; i / plan.image_hz <= plan.duration_s - 0.05; ++i) {
    const double t_s = i / plan.image_hz - 0.005;
    messages.emplace_back(at(t_s), world.frame(at(t_s), plan.right));
  }
  for (int i = 1; i * 0.1 <= plan.duration_s - 0.05; ++i) {
    const double t_s = i * 0.1;
    if (t_s < plan.lidar_begin_s || t_s > plan.lidar_end_s) continue;
    messages.emplace_back(at(t_s + plan.lidar_delay_s), world.packet(at(t_s)));
  }
  std::stable_sort(messages.begin(), messages.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<LogMessage> ordered;
  for (auto& [t_ns, message] : messages) ordered.push_back(std::move(message));
  return ordered;
}

/// Predicts what it is told: a function of the number of LiDAR pixels that it was fed.
class FakePredictor : public DepthPredictor {
 public:
  using Rule = std::function<double(int points)>;
  explicit FakePredictor(Rule depth_of_points_m) : rule_(std::move(depth_of_points_m)) {}

  std::unique_ptr<EncodedImage> encode(const PredictorView& view) override {
    ++encoded;
    last_view = view;
    auto code = std::make_unique<Code>();
    code->size = view.left.size();
    return code;
  }
  cv::Mat refine(const EncodedImage& image, const cv::Mat& sparse_m) override {
    ++refined;
    points.push_back(cv::countNonZero(sparse_m));
    return {static_cast<const Code&>(image).size, CV_32FC1, cv::Scalar(rule_(points.back()))};
  }

  PredictorView last_view;
  int encoded = 0;
  int refined = 0;
  std::vector<int> points;

 private:
  struct Code : EncodedImage {
    cv::Size size;
  };
  Rule rule_;
};

}  // namespace alight::fakes
