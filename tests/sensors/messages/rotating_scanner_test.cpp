#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "dataset/build/depth_map_builder.hpp"
#include "geometry/frames.hpp"
#include "tests/sensors/messages/cloud_message.hpp"
#include "tests/sensors/test_flight.hpp"

/// A car with a rotating scanner and a camera that looks ahead, as KITTI has them, drives a curve between two walls. The
/// cameras and mountings are those of configs/rigs/kitti.yaml.
namespace alight::testing {
namespace {

namespace fs = std::filesystem;

constexpr double kHeight_m = 0.93;  // of the IMU over the road
constexpr double kWall_m = 9;       // either side, and before and behind four times as far
constexpr double kSpeed_mps = 8;
constexpr double kYawRate_radps = 0.5;
constexpr double kPeriod_s = 0.1;
constexpr int kColumns = 720;
constexpr int kRings = 24;

enum class PointOrder { kAsMeasured, kByRing };

Eigen::Isometry3d T_world_imu(double t_s) {
  const double yaw_rad = kYawRate_radps * t_s;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const double radius_m = kSpeed_mps / kYawRate_radps;
  T.translation() << radius_m * std::sin(yaw_rad), radius_m * (1 - std::cos(yaw_rad)), kHeight_m;
  return T;
}

/// Distance along a ray to the road or the nearest wall.
double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  double range_m = 1e9;
  const auto meet = [&](int axis, double value) {
    const double range = (value - origin[axis]) / direction[axis];
    if (range > 0) range_m = std::min(range_m, range);
  };
  meet(0, 4 * kWall_m);
  meet(0, -4 * kWall_m);
  meet(1, kWall_m);
  meet(1, -kWall_m);
  meet(2, 0);
  return range_m;
}

/// Distance of a point to the nearest of these surfaces.
double off_surface_m(const Eigen::Vector3d& p_world) {
  return std::min({std::abs(p_world.z()), std::abs(std::abs(p_world.y()) - kWall_m),
                   std::abs(std::abs(p_world.x()) - 4 * kWall_m)});
}

/// One turn, clockwise seen from above, from behind over ahead to behind.
std::vector<std::vector<double>> scan(double begin_s, const Eigen::Isometry3d& T_imu_lidar,
                                      PointOrder order) {
  std::vector<std::vector<double>> points;
  for (int column = 0; column < kColumns; ++column) {
    const double share = (column + 0.5) / kColumns;
    const Eigen::Isometry3d T_world_lidar = T_world_imu(begin_s + share * kPeriod_s) * T_imu_lidar;
    const double azimuth_rad = kPi - 2 * kPi * share;
    for (int ring = 0; ring < kRings; ++ring) {
      const double elevation_rad = to_radians(2 - ring);
      const Eigen::Vector3d ray(std::cos(elevation_rad) * std::cos(azimuth_rad),
                                std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad));
      const Eigen::Vector3d p = ray * cast(T_world_lidar.translation(), T_world_lidar.linear() * ray);
      points.push_back({p.x(), p.y(), p.z(), 0.4, static_cast<double>(ring), share * kPeriod_s});
    }
  }
  if (order == PointOrder::kByRing) {
    std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a[4] < b[4]; });
  }
  return points;
}

struct Drive {
  CloudLayout layout;
  PointOrder order = PointOrder::kAsMeasured;
};

class RotatingScanner : public ::testing::Test {
 protected:
  RotatingScanner() : rig_(load_rig(fs::path(ALIGHT_SOURCE_DIR) / "configs" / "rigs" / "kitti.yaml")) {
    T_imu_lidar_ = rig_.cam0.T_camera_imu->inverse() * rig_.lidar0->T_camera_lidar;
    rig_.cam1.reset();  // one camera is enough here
    rig_.lidar0->timeshift_s = 0;
  }

  fs::path record(const Drive& drive) const {
    fs::path path = folder_.path() / "drive.bag";
    rosbag::Bag bag(path.string(), rosbag::bagmode::Write);
    const cv::Size size = rig_.cam0.camera.intrinsics.size();
    for (int tick = 0; tick <= 100; ++tick) {
      const double t_s = tick * 0.01;
      const std::int64_t t_ns = kStart_ns + to_nanoseconds(t_s);
      const Eigen::Isometry3d T = T_world_imu(t_s);
      sensor_msgs::Imu imu;
      imu.header = header_at(t_ns);
      const Eigen::Quaterniond q(T.linear());
      imu.orientation.z = q.z();
      imu.orientation.w = q.w();
      bag.write("/kitti/oxts/imu", ros_time(t_ns), imu);
      bag.write("/kitti/oxts/gps/fix", ros_time(t_ns), fix_message(t_ns, T.translation()));
      if (tick % 10 == 5)
        bag.write(rig_.cam0.topic, ros_time(t_ns), image_message(t_ns, size.width, size.height, "mono8"));
      if (tick % 10 != 0) continue;
      auto points = scan(t_s, T_imu_lidar_, drive.order);
      for (auto& point : points) point.resize(drive.layout.fields.size());
      bag.write(rig_.lidar0->topic, ros_time(t_ns + 100'000'000), cloud_message(t_ns, drive.layout, points));
    }
    return path;
  }

  /// Share of the depth pixels whose point lies on a surface to 8 cm.
  double share_on_surfaces(const Drive& drive, const PointTiming& timing) {
    rig_.lidar0->points = timing;
    LogConfig log_config;
    log_config.attitude_topic = "/kitti/oxts/imu";
    log_config.position_topic = "/kitti/oxts/gps/fix";
    log_config.height_topic.reset();
    DepthMapConfig config;
    config.crop_px.reset();
    config.window_before_s = config.window_after_s = 0.06;
    config.every_nth_image = 1;
    FlightLog log(record(drive), rig_, log_config);
    DepthMapBuilder builder(rig_, config);
    std::size_t pixels = 0;
    std::size_t close = 0;
    int samples = 0;
    const auto take = [&] {
      while (const auto sample = builder.next()) {
        ++samples;
        for (int v = 0; v < sample->sparse.depth_m.rows; ++v) {
          for (int u = 0; u < sample->sparse.depth_m.cols; ++u) {
            const double depth_m = static_cast<double>(sample->sparse.depth_m.at<float>(v, u));
            if (depth_m == 0) continue;
            // The log's world begins at its first fix.
            Eigen::Vector3d p_world = sample->T_world_camera * (builder.rig().intrinsics.ray(u, v) * depth_m);
            p_world += T_world_imu(0).translation();
            ++pixels;
            if (off_surface_m(p_world) < 0.08) ++close;
          }
        }
      }
    };
    LogMessage message;
    while (log.next(message)) {
      builder.add(std::move(message));
      take();
    }
    builder.finish();
    take();
    EXPECT_GE(samples, 9);
    EXPECT_GT(pixels, 15'000u);
    return static_cast<double>(close) / static_cast<double>(pixels);
  }

  ScratchFolder folder_;
  Rig rig_;
  Eigen::Isometry3d T_imu_lidar_;
};

PointTiming by_azimuth() {
  PointTiming timing;
  timing.scan_period_s = kPeriod_s;
  timing.spread = PointTiming::Spread::kClockwise;
  timing.scan_start_rad = kPi;
  return timing;
}

PointTiming in_order() {
  PointTiming timing;
  timing.scan_period_s = kPeriod_s;
  return timing;
}

/// The points' own times are in seconds, which is told by their size.
TEST_F(RotatingScanner, PointsOf22BytesHaveTheirTimesInEitherByteOrder) {
  for (const bool big_endian : {false, true}) {
    CloudLayout layout = velodyne_layout();
    layout.big_endian = big_endian;
    EXPECT_GT(share_on_surfaces({layout, PointOrder::kByRing}, {}), 0.99) << big_endian;
  }
}

TEST_F(RotatingScanner, PointsOf18BytesGetTheirTimesFromTheTurnOrFromTheirOrder) {
  for (const bool big_endian : {false, true}) {
    CloudLayout layout = kitti_layout();
    layout.big_endian = big_endian;
    EXPECT_GT(share_on_surfaces({layout, PointOrder::kByRing}, by_azimuth()), 0.99) << big_endian;
    EXPECT_GT(share_on_surfaces({layout, PointOrder::kAsMeasured}, in_order()), 0.99) << big_endian;
  }
}

/// What the times are good for: with one time a scan, or the wrong way round, the walls bend.
TEST_F(RotatingScanner, WithoutOrWithWrongTimesPointsMissTheWalls) {
  PointTiming at_stamp;
  at_stamp.scan_period_s = 0;
  EXPECT_LT(share_on_surfaces({kitti_layout(), PointOrder::kByRing}, at_stamp), 0.8);
  PointTiming wrong_way = by_azimuth();
  wrong_way.spread = PointTiming::Spread::kCounterclockwise;
  EXPECT_LT(share_on_surfaces({kitti_layout(), PointOrder::kByRing}, wrong_way), 0.95);
}

}  // namespace
}  // namespace alight::testing
