#include "dataset/build/depth_map_builder.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "geometry/frames.hpp"
#include "tests/sensors/test_flight.hpp"

namespace alight::testing {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

/// Where a vehicle is that climbs, flies sideways, yaws at 30 deg/s and rocks.
Eigen::Isometry3d moving_pose(double t_s) {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = (Eigen::AngleAxisd(to_radians(30) * t_s, Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(0.06 * std::sin(3 * t_s), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(0.08 * std::sin(2 * t_s), Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  T.translation() << 3 * t_s, -1 * t_s, 20 + 0.5 * t_s;
  return T;
}

/// n . p_world = d
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d(0.05, -0.08, 1).normalized();
  double distance_m = 0.7;
};

/// Where a ray from the LiDAR meets the plane, in LiDAR coordinates.
Eigen::Vector3d hit(const Plane& plane, const Eigen::Isometry3d& T_world_lidar,
                    const Eigen::Vector3d& ray_lidar) {
  const Eigen::Vector3d ray_world = T_world_lidar.linear() * ray_lidar;
  const double range_m =
      (plane.distance_m - plane.normal.dot(T_world_lidar.translation())) / plane.normal.dot(ray_world);
  return range_m * ray_lidar;
}

class PlaneFlight {
 public:
  /// @param point_times false: a driver that gives all points of a packet the packet's stamp
  explicit PlaneFlight(bool point_times) : point_times_(point_times), builder_(rig_, config()) {}

  static DepthMapConfig config() {
    DepthMapConfig config;
    config.crop_px.reset();
    config.window_before_s = 0.6;
    config.window_after_s = 0.6;
    return config;
  }

  /// Three seconds; every point is measured from where the LiDAR is at the point's own time.
  std::vector<BuiltSample> fly() {
    std::vector<BuiltSample> samples;
    for (std::int64_t ms = 0; ms <= 3000; ms += 5) {
      const std::int64_t t_ns = kStart_ns + ms * kMillisecond;
      const Eigen::Isometry3d T = moving_pose(static_cast<double>(ms) / 1000);
      builder_.add(AttitudeSample{t_ns, Eigen::Quaterniond(T.linear())});
      if (ms % 20 == 0) builder_.add(fix(t_ns, T.translation()));
      if (ms % 250 == 0)
        builder_.add(StereoFrame{t_ns, cv::Mat::zeros(48, 64, CV_8UC1), cv::Mat::zeros(48, 64, CV_8UC1)});
      if (ms % 100 == 0 && ms > 0) builder_.add(packet(t_ns - 100 * kMillisecond));
      while (auto sample = builder_.next()) samples.push_back(std::move(*sample));
    }
    builder_.finish();
    while (auto sample = builder_.next()) samples.push_back(std::move(*sample));
    return samples;
  }

  /// Errors of the depth map. A point stands anywhere in its pixel, so the truth is the range of the plane's
  /// depths over the pixel.
  std::vector<double> errors_m(const BuiltSample& sample) const {
    std::vector<double> errors;
    const Eigen::Isometry3d T_world_camera =
        moving_pose(to_seconds(sample.t_ns - kStart_ns)) * builder_.rig().T_camera_imu.inverse();
    for (int v = 0; v < sample.sparse.depth_m.rows; ++v) {
      for (int u = 0; u < sample.sparse.depth_m.cols; ++u) {
        const double depth_m = sample.sparse.depth_m.at<float>(v, u);
        if (depth_m == 0) continue;
        std::vector<double> corners_m;
        for (const double du : {-0.5, 0.5}) {
          for (const double dv : {-0.5, 0.5})
            corners_m.push_back(plane_depth_m(T_world_camera, u + du, v + dv));
        }
        const auto [low, high] = std::minmax_element(corners_m.begin(), corners_m.end());
        errors.push_back(std::max({0.0, *low - depth_m, depth_m - *high}));
      }
    }
    return errors;
  }

 private:
  double plane_depth_m(const Eigen::Isometry3d& T_world_camera, double u_px, double v_px) const {
    return hit(plane_, T_world_camera, builder_.rig().intrinsics.ray(u_px, v_px)).z();
  }

  PositionSample fix(std::int64_t t_ns, const Eigen::Vector3d& p_world) const {
    const Eigen::Vector3d geodetic = enu_.to_geodetic(p_world - moving_pose(0).translation());
    return {t_ns, GeodeticPosition{geodetic.x(), geodetic.y(), geodetic.z()}};
  }

  LidarPacket packet(std::int64_t t_ns) {
    LidarPacket packet;
    packet.t_ns = t_ns;
    std::uniform_real_distribution<double> lateral(-0.35, 0.35);
    const RectifiedRig& rig = builder_.rig();
    for (int i = 0; i < 2000; ++i) {
      const std::int64_t point_ns = t_ns + i * 50'000;
      const Eigen::Isometry3d T_world_lidar =
          moving_pose(to_seconds(point_ns - kStart_ns)) * rig.T_camera_imu.inverse() * rig.T_camera_lidar;
      const Eigen::Vector3d ray(1, lateral(random_), lateral(random_));
      packet.returns.push_back(
          {point_times_ ? point_ns : t_ns, hit(plane_, T_world_lidar, ray).cast<float>(), 0});
    }
    return packet;
  }

  bool point_times_;
  Rig rig_ = small_rig();
  Plane plane_;
  LocalEnu enu_{31.3, 121.5, 20.0};
  std::mt19937 random_{1};
  DepthMapBuilder builder_;
};

TEST(DepthMapBuilder, AMovingTurningVehicleSeesAPlaneToTheMillimetre) {
  PlaneFlight flight(true);
  const auto samples = flight.fly();
  ASSERT_GE(samples.size(), 10u);
  for (const BuiltSample& sample : samples) {
    const auto errors = flight.errors_m(sample);
    ASSERT_GT(errors.size(), 1000u);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3) << to_seconds(sample.t_ns - kStart_ns);
  }
}

/// The same check fails where the points of a packet share one pose: it does see the alignment.
TEST(DepthMapBuilder, WithoutPointTimesThePlaneIsDecimetresOff) {
  PlaneFlight flight(false);
  const auto samples = flight.fly();
  ASSERT_GE(samples.size(), 10u);
  for (const BuiltSample& sample : samples) {
    const auto errors = flight.errors_m(sample);
    EXPECT_GT(*std::max_element(errors.begin(), errors.end()), 0.1) << to_seconds(sample.t_ns - kStart_ns);
  }
}

/// A hover with chosen samples; `add_images` etc. fill it message by message.
class HoverTest : public ::testing::Test {
 protected:
  static std::int64_t at(std::int64_t ms) { return kStart_ns + ms * kMillisecond; }
  void poses(std::int64_t from_ms, std::int64_t to_ms) {
    for (std::int64_t ms = from_ms; ms <= to_ms; ms += 10) {
      builder_->add(AttitudeSample{at(ms), Eigen::Quaterniond::Identity()});
      builder_->add(PositionSample{at(ms), GeodeticPosition{31, 121, 0}});
    }
  }
  void image(std::int64_t ms) {
    builder_->add(StereoFrame{at(ms), cv::Mat::zeros(48, 64, CV_8UC3), cv::Mat::zeros(48, 64, CV_8UC3)});
  }
  /// One point at the picture's centre, `range_m` below.
  void point(std::int64_t ms, float range_m) {
    builder_->add(LidarPacket{at(ms), {{at(ms), {range_m, 0, 0}, 0}}, 0});
  }
  std::vector<BuiltSample> finish() {
    builder_->finish();
    std::vector<BuiltSample> samples;
    while (auto sample = builder_->next()) samples.push_back(std::move(*sample));
    return samples;
  }
  static DepthMapConfig config() {
    DepthMapConfig config;
    config.crop_px = 32;
    config.window_before_s = 0.2;
    config.window_after_s = 0.1;
    config.min_pixels = 0;
    return config;
  }
  void use(const DepthMapConfig& config, const Rig& rig = small_rig()) { builder_.emplace(rig, config); }
  std::optional<DepthMapBuilder> builder_ = DepthMapBuilder(small_rig(), config());
};

double only_depth_m(const BuiltSample& sample) {
  double max_m = 0;
  cv::minMaxLoc(sample.sparse.depth_m, nullptr, &max_m);
  return max_m;
}

TEST_F(HoverTest, TheWindowHoldsItsEndsAndNothingBeyond) {
  poses(0, 1000);
  image(500);
  point(299, 4);
  point(300, 5);
  point(600, 6);
  point(601, 7);
  const auto samples = finish();
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(samples[0].points, 2);
}

TEST_F(HoverTest, ThePointNearestInTimeWinsAndItsOffsetIsKept) {
  poses(0, 1000);
  image(500);
  point(440, 5);
  point(530, 8);
  const auto samples = finish();
  ASSERT_EQ(samples.size(), 1u);
  const double lidar_below_camera_m = small_rig().lidar0->T_camera_lidar.translation().z();
  EXPECT_NEAR(only_depth_m(samples[0]), 8 + lidar_below_camera_m, 1e-6);
  double max_us = 0;
  cv::minMaxLoc(samples[0].sparse.offset_us, nullptr, &max_us);
  EXPECT_EQ(max_us, 30'000);
  EXPECT_EQ(samples[0].sparse.count(), 1);
}

TEST_F(HoverTest, PointsAndImagesInAPoseGapAreDroppedAndCounted) {
  poses(0, 450);
  poses(800, 1200);  // a gap of 0.35 s, longer than max_pose_gap_s
  image(400);
  image(500);
  point(420, 5);
  point(460, 5);
  image(1000);
  point(1000, 5);
  const auto samples = finish();
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0].points, 1);
  EXPECT_EQ(builder_->dropped().at("images without a pose"), 1);
  EXPECT_EQ(builder_->dropped().at("LiDAR points without a pose"), 1);
}

TEST_F(HoverTest, DoubleStampsAreCounted) {
  poses(0, 1000);
  for (const int ms : {100, 250, 250, 200}) image(ms);
  EXPECT_EQ(finish().size(), 2u);
  EXPECT_EQ(builder_->dropped().at("images not later than the one before"), 2);
}

TEST_F(HoverTest, ImagesWithTooFewPixelsAreCounted) {
  DepthMapConfig demanding = config();
  demanding.min_pixels = 2;
  use(demanding);
  poses(0, 1000);
  image(500);
  point(500, 5);
  EXPECT_TRUE(finish().empty());
  EXPECT_EQ(builder_->dropped().at("images with too few depth pixels"), 1);
}

TEST_F(HoverTest, AnImageWaitsForItsWindowAndNoLonger) {
  poses(0, 600);
  image(500);
  point(550, 5);
  EXPECT_FALSE(builder_->next());
  poses(610, 620);
  point(610, 5);
  EXPECT_TRUE(builder_->next());
}

TEST_F(HoverTest, ADeadLidarDoesNotHoldTheImagesForEver) {
  poses(0, 600);
  image(500);
  EXPECT_FALSE(builder_->next());
  poses(610, 3000);
  EXPECT_TRUE(builder_->next());
}

TEST_F(HoverTest, PicturesAreCroppedWithTheirIntrinsics) {
  poses(0, 1000);
  image(500);
  const auto samples = finish();
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(samples[0].left.size(), cv::Size(32, 32));
  EXPECT_EQ(samples[0].right.size(), cv::Size(32, 32));
  EXPECT_EQ(builder_->rig().intrinsics.cx_px, 15.5);
  EXPECT_EQ(builder_->rig().intrinsics.cy_px, 15.5);
  EXPECT_TRUE(std::isnan(samples[0].height_m));
  const Eigen::Vector3d p_world_camera = samples[0].T_world_camera.translation();
  EXPECT_TRUE(p_world_camera.isApprox(small_rig().cam0.T_camera_imu->inverse().translation(), 1e-9));
}

TEST_F(HoverTest, ACropLargerThanTheImageIsAConfigurationError) {
  DepthMapConfig large = config();
  large.crop_px = 49;
  EXPECT_THAT(message_of<ConfigError>([&] { use(large); }), ::testing::HasSubstr("49 does not fit"));
}

}  // namespace
}  // namespace alight::testing
