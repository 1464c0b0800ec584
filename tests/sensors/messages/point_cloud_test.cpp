#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "tests/sensors/messages/cloud_message.hpp"
#include "tests/sensors/messages/decoding.hpp"

namespace alight::testing {
namespace {

using sensor_msgs::PointField;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

LidarPacket packet_of(const sensor_msgs::PointCloud2& message, const PointTiming& points = {},
                      StampSource stamp = StampSource::kHeader, std::int64_t receive_ns = kStart_ns) {
  DecodeOptions options;
  options.points = points;
  options.stamp = stamp;
  return decoded<LidarPacket>(LogRole::kLidar, message, options, receive_ns);
}

/// Times of the points after the stamp, ms.
std::vector<double> offsets_ms(const LidarPacket& packet) {
  std::vector<double> offsets;
  for (const LidarReturn& point : packet.returns)
    offsets.push_back(static_cast<double>(point.t_ns - kStart_ns) / 1e6);
  return offsets;
}

/// x y z and a time of any name and type; the points lie along x, 5 m and more away.
sensor_msgs::PointCloud2 timed(const std::string& name, std::uint8_t type, const std::vector<double>& times) {
  CloudLayout layout{{{name, type, 0}, {"x", 7, 8}, {"y", 7, 12}, {"z", 7, 16}}, 20};
  std::vector<std::vector<double>> points;
  for (const double t : times) points.push_back({t, 5.0 + static_cast<double>(points.size()), 0, 0});
  return cloud_message(kStart_ns, layout, points);
}

std::string error_of(const sensor_msgs::PointCloud2& message, const PointTiming& points = {}) {
  DecodeOptions options;
  options.points = points;
  return error(LogRole::kLidar, message, options);
}

/// Every type of number, fields in another order with gaps between, both byte orders: the same points.
TEST(PointCloud, LayoutDoesNotMatter) {
  PointTiming timing;
  timing.scan_period_s = 0;
  for (const bool big_endian : {false, true}) {
    for (const std::uint8_t type :
         {PointField::INT8, PointField::INT16, PointField::INT32, PointField::FLOAT32, PointField::FLOAT64,
          PointField::UINT8, PointField::UINT16, PointField::UINT32}) {
      const CloudLayout layout{{{"z", type, 3},
                                {"reflectivity", PointField::UINT16, 12},
                                {"y", 7, 14},
                                {"other", PointField::FLOAT64, 20},
                                {"x", 8, 29}},
                               40,
                               big_endian};
      const LidarPacket packet = packet_of(
          cloud_message(kStart_ns, layout, {{3, 77, -1.5, 9, 10.25}, {4, 300, 2.5, 9, 11}}), timing);
      ASSERT_EQ(packet.returns.size(), 2u);
      EXPECT_EQ(packet.returns[0].p_lidar, Eigen::Vector3f(10.25F, -1.5F, 3)) << int{type};
      EXPECT_EQ(packet.returns[0].reflectivity, 77);
      EXPECT_EQ(packet.returns[1].p_lidar, Eigen::Vector3f(11, 2.5F, 4));
      EXPECT_EQ(packet.returns[1].reflectivity, 255) << "clamped";
    }
  }
}

TEST(PointCloud, RowsMayBePadded) {
  sensor_msgs::PointCloud2 message = timed("t", PointField::UINT32, {0, 10'000'000, 20'000'000, 30'000'000});
  message.height = 2;
  message.width = 2;
  message.row_step = 45;
  message.data.insert(message.data.begin() + 40, 5, 0xFF);
  message.data.insert(message.data.end(), 5, 0xFF);
  EXPECT_EQ(offsets_ms(packet_of(message)), (std::vector<double>{0, 10, 20, 30}));
}

TEST(PointCloud, DropsAndCountsWhatIsNoEcho) {
  const double inf = std::numeric_limits<double>::infinity();
  const LidarPacket packet = packet_of(cloud_message(kStart_ns, velodyne_layout(),
                                                     {{0, 0, 0, 1, 0, 0.01},
                                                      {kNaN, 1, 1, 1, 0, 0.02},
                                                      {5, inf, 1, 1, 0, 0.03},
                                                      {0.1, 0, 0, 1, 0, 0.04},
                                                      {1000, 0, 0, 1, 0, 0.05},
                                                      {8, 0, 0, 1, 0, kNaN},
                                                      {9, 0, 0, kNaN, 0, 0.07}}));
  ASSERT_EQ(packet.returns.size(), 1u);
  EXPECT_EQ(packet.returns[0].p_lidar.x(), 9);
  EXPECT_EQ(packet.returns[0].reflectivity, 0);
  EXPECT_EQ(packet.dropped, 6);
}

TEST(PointCloud, AnEmptyCloudIsOne) {
  const LidarPacket packet = packet_of(cloud_message(kStart_ns, velodyne_layout(), {}));
  EXPECT_TRUE(packet.returns.empty());
  EXPECT_EQ(packet.dropped, 0);
}

TEST(PointCloud, SizesThatLieAreRefused) {
  const sensor_msgs::PointCloud2 whole = timed("t", PointField::UINT32, {0, 10'000'000});
  const auto refused = [&](const std::function<void(sensor_msgs::PointCloud2&)>& change) {
    sensor_msgs::PointCloud2 message = whole;
    change(message);
    return error_of(message);
  };
  EXPECT_EQ(refused([](auto&) {}), "");
  EXPECT_THAT(refused([](auto& m) { m.width = 3; }), HasSubstr("cloud of 40 bytes"));
  EXPECT_THAT(refused([](auto& m) { m.width = 0xFFFFFFFF; }), HasSubstr("4294967295 points"));
  EXPECT_THAT(refused([](auto& m) { m.height = 0xFFFFFFFF; }), HasSubstr("4294967295 rows"));
  EXPECT_THAT(refused([](auto& m) { m.point_step = 0; }), HasSubstr("ends behind its point"));
  EXPECT_THAT(refused([](auto& m) { m.fields[1].offset = 0xFFFFFFFF; }), HasSubstr("field x ends behind"));
  EXPECT_THAT(refused([](auto& m) { m.fields[1].datatype = 9; }), HasSubstr("unknown type 9"));
  EXPECT_THAT(refused([](auto& m) { m.fields[2].name = "Y"; }), HasSubstr("no field y among t, x, Y, z"));
}

TEST(PointTimes, UnitAndBaseAreToldByTypeAndMagnitude) {
  const std::vector<double> expected = {0, 40, 100};
  EXPECT_EQ(offsets_ms(packet_of(timed("t", PointField::UINT32, {0, 40e6, 100e6}))), expected) << "Ouster";
  EXPECT_EQ(offsets_ms(packet_of(timed("offset_time", PointField::UINT32, {0, 40e3, 100e3}))), expected);
  EXPECT_EQ(offsets_ms(packet_of(timed("time", PointField::FLOAT64, {0, 0.04, 0.1}))), expected);
  EXPECT_EQ(offsets_ms(packet_of(timed("time_stamp", PointField::FLOAT32, {0, 40e3, 100e3}))), expected);
  const double start_ns = static_cast<double>(kStart_ns);
  const auto near_expected = [&](const LidarPacket& packet, double tolerance_ms) {
    ASSERT_EQ(packet.returns.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(offsets_ms(packet)[i], expected[i], tolerance_ms);
  };
  near_expected(packet_of(timed("timestamp", PointField::FLOAT64,
                                {start_ns * 1e-9, start_ns * 1e-9 + 0.04, start_ns * 1e-9 + 0.1})),
                1e-3);
  near_expected(
      packet_of(timed("timestamp", PointField::FLOAT64, {start_ns, start_ns + 40e6, start_ns + 100e6})),
      1e-3);
  near_expected(packet_of(timed("timestamp", PointField::FLOAT64,
                                {start_ns * 1e-3, start_ns * 1e-3 + 40e3, start_ns * 1e-3 + 100e3})),
                1e-3);
}

TEST(PointTimes, SecondsAndNanosecondsMayBeTwoFields) {
  const CloudLayout layout{{{"x", 7, 0}, {"y", 7, 4}, {"z", 7, 8}, {"time_sec", 6, 12}, {"time_nsec", 6, 16}},
                           20};
  const double seconds = static_cast<double>(kStart_ns / kNanosecondsPerSecond);
  const LidarPacket packet =
      packet_of(cloud_message(kStart_ns, layout, {{5, 0, 0, seconds, 0}, {6, 0, 0, seconds, 65'536'000}}));
  EXPECT_EQ(offsets_ms(packet), (std::vector<double>{0, 65.536}));
}

/// The newer Velodyne driver counts back from the stamp.
TEST(PointTimes, MayBeNegative) {
  const auto offsets = offsets_ms(packet_of(timed("time", PointField::FLOAT32, {-0.125, -0.0625, 0})));
  EXPECT_EQ(offsets, (std::vector<double>{-125, -62.5, 0}));
}

TEST(PointTimes, WhatIsNotClearIsAskedFor) {
  const auto names_key = AllOf(HasSubstr("point_time_unit"), HasSubstr("lidar0"));
  EXPECT_THAT(error_of(timed("time", PointField::FLOAT32, {0, 40, 100})), names_key) << "ms?";
  EXPECT_THAT(error_of(timed("t", PointField::UINT32, {0, 1'500'000})), names_key) << "us or ns?";
  EXPECT_THAT(error_of(timed("t", PointField::UINT32, {0, 0, 0})), names_key) << "no times at all?";
  EXPECT_THAT(error_of(timed("time", PointField::FLOAT64, {1234.0, 1234.1})), names_key) << "since power-on?";
  PointTiming timing;
  timing.unit = PointTiming::Unit::kMilliseconds;
  EXPECT_EQ(offsets_ms(packet_of(timed("time", PointField::FLOAT32, {0, 40, 100}), timing)),
            (std::vector<double>{0, 40, 100}));
  timing.unit = PointTiming::Unit::kSeconds;
  EXPECT_THAT(error_of(timed("time", PointField::FLOAT32, {0, 40, 100}), timing),
              HasSubstr("more than 10 s"));
}

TEST(PointTimes, AbsoluteOnesNeedDoubleNumbersOnTheStampsDay) {
  PointTiming timing;
  timing.base = PointTiming::Base::kAbsolute;
  const double start_s = to_seconds(kStart_ns);
  EXPECT_THAT(error_of(timed("time", PointField::FLOAT32, {start_s, start_s + 0.1}), timing),
              HasSubstr("float32 cannot hold"));
  EXPECT_THAT(error_of(timed("time", PointField::FLOAT64, {start_s - 1e6, start_s - 1e6 + 0.1}), timing),
              HasSubstr("point_time_base"));
}

TEST(PointTimes, OfAClockOfItsOwnOnlyDifferencesCount) {
  PointTiming timing;
  timing.base = PointTiming::Base::kOwnClock;
  const auto message = timed("time", PointField::FLOAT64, {1234.0, 1234.0625, 1234.125});
  EXPECT_EQ(offsets_ms(packet_of(message, timing)), (std::vector<double>{0, 62.5, 125}));
  timing.stamp_at = PointTiming::StampAt::kEnd;
  EXPECT_EQ(offsets_ms(packet_of(message, timing)), (std::vector<double>{-125, -62.5, 0}));
}

TEST(PointTimes, WithTheReceiveTimeAsStampAbsoluteOnesFollowIt) {
  const double start_ns = static_cast<double>(kStart_ns);
  const auto message = timed("timestamp", PointField::FLOAT64, {start_ns, start_ns + 65'536'000});
  const LidarPacket packet = packet_of(message, {}, StampSource::kReceive, kStart_ns + 3 * kMillisecond_ns);
  EXPECT_EQ(offsets_ms(packet), (std::vector<double>{3, 68.536}));
  EXPECT_EQ(packet.t_ns, kStart_ns + 3 * kMillisecond_ns);
}

TEST(PointTimes, AStampAtTheEndMovesTheScanBack) {
  PointTiming timing;
  timing.stamp_at = PointTiming::StampAt::kEnd;
  const auto message = timed("t", PointField::UINT32, {0, 40e6, 99e6});
  EXPECT_EQ(offsets_ms(packet_of(message, timing)), (std::vector<double>{-99, -59, 0}));
  timing.scan_period_s = 0.1;
  EXPECT_EQ(offsets_ms(packet_of(message, timing)), (std::vector<double>{-100, -60, -1}));
}

TEST(PointTimes, TheFieldMayBeNamedOrDeniedOrMissing) {
  const auto message = timed("moment", PointField::UINT32, {0, 40e6, 100e6});
  EXPECT_THAT(error_of(message), AllOf(HasSubstr("scan_period_s"), HasSubstr("point_time")));
  PointTiming timing;
  timing.field = "moment";
  EXPECT_EQ(offsets_ms(packet_of(message, timing)), (std::vector<double>{0, 40, 100}));
  timing.field = "time";
  EXPECT_THAT(error_of(message, timing), AllOf(HasSubstr("no field time"), HasSubstr("point_time of")));
  timing.field = "none";
  timing.scan_period_s = 0.3;
  EXPECT_EQ(offsets_ms(packet_of(timed("t", PointField::UINT32, {9e6, 9e6, 9e6}), timing)),
            (std::vector<double>{0, 100, 200}));
}

TEST(PointTimes, WithoutAFieldPointsAreSpreadInTheirOrderOrAsTheScannerTurns) {
  const auto message = cloud_message(kStart_ns, kitti_layout(),
                                     {{5, 0, 0, 1, 0}, {0, 5, 0, 1, 0}, {-5, 0, 0, 1, 0}, {0, -5, 0, 1, 0}});
  PointTiming timing;
  timing.scan_period_s = 0.1;
  EXPECT_EQ(offsets_ms(packet_of(message, timing)), (std::vector<double>{0, 25, 50, 75}));
  timing.stamp_at = PointTiming::StampAt::kEnd;
  EXPECT_EQ(offsets_ms(packet_of(message, timing)), (std::vector<double>{-100, -75, -50, -25}));
  timing.stamp_at = PointTiming::StampAt::kStart;
  timing.spread = PointTiming::Spread::kClockwise;
  EXPECT_EQ(offsets_ms(packet_of(message, timing)), (std::vector<double>{0, 75, 50, 25}));
  timing.spread = PointTiming::Spread::kCounterclockwise;
  timing.scan_start_rad = to_radians(180);
  const auto offsets = offsets_ms(packet_of(message, timing));
  EXPECT_NEAR(offsets[0], 50, 1e-3);
  EXPECT_NEAR(offsets[1], 75, 1e-3);
  EXPECT_NEAR(offsets[3], 25, 1e-3);
}

TEST(PointTimes, TheLivoxMessageTakesTheSameOptions) {
  DecodeOptions options;
  options.points.stamp_at = PointTiming::StampAt::kEnd;
  const livox_ros_driver::CustomMsg message = livox_message(kStart_ns, 5);
  const auto packet = decoded<LidarPacket>(LogRole::kLidar, message, options);
  EXPECT_EQ(packet.returns.back().t_ns, kStart_ns);
  EXPECT_EQ(packet.returns.front().t_ns, kStart_ns - message.points.back().offset_time);
}

}  // namespace
}  // namespace alight::testing
