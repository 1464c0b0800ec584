#include "ros/report_messages.hpp"

#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "geometry/frames.hpp"

namespace alight {
namespace {

using ::testing::HasSubstr;

constexpr PinholeIntrinsics kCamera{100, 100, 2, 1, 5, 3};

/// 5 x 3 pixels at 10 m; the corner is unknown, the middle is at 20 m and blue.
FrameReport small_frame() {
  FrameReport frame;
  frame.depth.t_ns = 1'700'000'000'123'456'789;
  frame.depth.source = DepthSource::kLidar;
  frame.depth.depth_m = cv::Mat(3, 5, CV_32FC1, cv::Scalar(10));
  frame.depth.depth_m.at<float>(0, 0) = 0;
  frame.depth.depth_m.at<float>(1, 2) = 20;
  frame.depth.left = cv::Mat(3, 5, CV_8UC3, cv::Scalar(30, 20, 10));
  frame.depth.left.at<cv::Vec3b>(1, 2) = {255, 0, 0};
  return frame;
}

float float_at(const std::vector<std::uint8_t>& bytes, std::size_t index) {
  float number;
  std::memcpy(&number, &bytes[index * sizeof number], sizeof number);
  return number;
}

TEST(ReportMessagesTest, DepthIsInMetresAndUnknownIsNan) {
  const auto image = depth_image(small_frame(), kCamera, {});
  EXPECT_EQ(image.encoding, "32FC1");
  EXPECT_EQ(image.width, 5u);
  EXPECT_EQ(image.height, 3u);
  EXPECT_EQ(image.step, 20u);
  EXPECT_EQ(image.header.stamp.sec, 1'700'000'000u);
  EXPECT_EQ(image.header.stamp.nsec, 123'456'789u);
  EXPECT_EQ(image.header.frame_id, "left_camera_optical_frame");
  EXPECT_TRUE(std::isnan(float_at(image.data, 0)));
  EXPECT_EQ(float_at(image.data, 1), 10.0f);
  EXPECT_EQ(float_at(image.data, 7), 20.0f);
}

TEST(ReportMessagesTest, AnImageWithoutDepthIsUnknownAndUnsafeThroughout) {
  FrameReport frame;
  const auto image = depth_image(frame, kCamera, {});
  ASSERT_EQ(image.data.size(), 60u);
  for (std::size_t i = 0; i < 15; ++i) EXPECT_TRUE(std::isnan(float_at(image.data, i)));
  const auto mask = safe_mask(frame, kCamera, {});
  EXPECT_EQ(mask.encoding, "mono8");
  EXPECT_EQ(mask.data, std::vector<std::uint8_t>(15, 0));
  EXPECT_EQ(points(frame, kCamera, 1, {}).width, 0u);
  EXPECT_TRUE(transforms(frame, {}).transforms.empty());
}

TEST(ReportMessagesTest, PointsLieOnTheirPixelsRays) {
  const auto cloud = points(small_frame(), kCamera, 1, {});
  ASSERT_EQ(cloud.width, 14u);  // one of fifteen is unknown
  EXPECT_EQ(cloud.point_step, 16u);
  ASSERT_EQ(cloud.data.size(), 14u * 16u);
  // The first known pixel is (1, 0).
  EXPECT_FLOAT_EQ(float_at(cloud.data, 0), -0.1f);
  EXPECT_FLOAT_EQ(float_at(cloud.data, 1), -0.1f);
  EXPECT_FLOAT_EQ(float_at(cloud.data, 2), 10.0f);
  // Pixel (2, 1) is the principal point.
  const std::size_t middle = 6 * 4;
  EXPECT_FLOAT_EQ(float_at(cloud.data, middle), 0.0f);
  EXPECT_FLOAT_EQ(float_at(cloud.data, middle + 2), 20.0f);
  std::uint32_t rgb;
  std::memcpy(&rgb, &cloud.data[(middle + 3) * 4], sizeof rgb);
  EXPECT_EQ(rgb, 0x0000ffu);
  std::memcpy(&rgb, &cloud.data[3 * 4], sizeof rgb);
  EXPECT_EQ(rgb, 0x0a141eu);
  EXPECT_EQ(points(small_frame(), kCamera, 2, {}).width,
            5u);  // rows 0, 2; columns 0, 2, 4; without the corner
}

TEST(ReportMessagesTest, TheMarkerIsACircleOfTheSitesRadius) {
  FrameReport frame = small_frame();
  EXPECT_EQ(landing_site_marker(frame, {}).action, visualization_msgs::Marker::DELETE);
  TrackedSite site;
  site.circle.radius_m = 3;
  site.p_world = {1, 2, -4};
  frame.decision.site = site;
  const auto waiting = landing_site_marker(frame, {});
  EXPECT_EQ(waiting.action, visualization_msgs::Marker::ADD);
  EXPECT_EQ(waiting.header.frame_id, "map");
  EXPECT_EQ(waiting.color.r, 1.0f);
  EXPECT_EQ(waiting.pose.position.z, -4);
  for (const auto& corner : waiting.points) EXPECT_NEAR(std::hypot(corner.x, corner.y), 3, 1e-12);
  frame.decision.site->accepted = true;
  EXPECT_EQ(landing_site_marker(frame, {}).color.r, 0.0f);
  EXPECT_EQ(landing_site(frame, *frame.decision.site, {}).pose.position.y, 2);
}

TEST(ReportMessagesTest, TheLevelCameraIsAChildOfTheCamera) {
  FrameReport frame = small_frame();
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.linear() = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  T_world_camera.translation() = Eigen::Vector3d(1, 2, 30);
  frame.depth.T_world_camera = T_world_camera;
  frame.selection = SiteSelection{};
  frame.selection->R_level_camera = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  const auto message = transforms(frame, {});
  ASSERT_EQ(message.transforms.size(), 2u);
  EXPECT_EQ(message.transforms[0].header.frame_id, "map");
  EXPECT_EQ(message.transforms[0].child_frame_id, "left_camera_optical_frame");
  EXPECT_EQ(message.transforms[0].transform.translation.z, 30);
  EXPECT_EQ(message.transforms[1].child_frame_id, "left_camera_level_frame");
  EXPECT_NEAR(message.transforms[1].transform.rotation.x, -std::sin(0.25), 1e-12);
}

TEST(ReportMessagesTest, HealthIsTheSensorsLevel) {
  HealthReport health;
  EXPECT_EQ(sensor_status("/alight", health).level, diagnostic_msgs::DiagnosticStatus::OK);
  health.state = HealthState::kDegraded;
  health.findings = {{"left camera", "frozen", "20 equal images", 5}};
  const auto degraded = sensor_status("/alight", health);
  EXPECT_EQ(degraded.level, diagnostic_msgs::DiagnosticStatus::WARN);
  EXPECT_EQ(degraded.message, "left camera frozen");
  EXPECT_EQ(degraded.values.front().value, "20 equal images");
  health.state = HealthState::kFailed;
  EXPECT_EQ(sensor_status("/alight", health).level, diagnostic_msgs::DiagnosticStatus::ERROR);
}

TEST(ReportMessagesTest, SilentAndUnreadableTopicsAreNamed) {
  const auto status = topic_status("/alight", {{"/left", "left camera", 3, true, false, ""},
                                               {"/livox", "LiDAR", 9, false, true, "type is wrong"}});
  EXPECT_EQ(status.level, diagnostic_msgs::DiagnosticStatus::ERROR);
  EXPECT_EQ(status.message, "/left is silent; type is wrong");
  EXPECT_THAT(status.values.front().value, HasSubstr("nobody publishes"));
}

TEST(ReportMessagesTest, OnlyNewLossesAreAWarning) {
  RunnerStatistics statistics;
  statistics.dropped["too slow"] = 4;
  const FrameReport last = small_frame();
  EXPECT_EQ(engine_status("/alight", statistics, {}, &last, 3).level,
            diagnostic_msgs::DiagnosticStatus::WARN);
  const auto unchanged = engine_status("/alight", statistics, {{"no echo", 7}}, &last, 4);
  EXPECT_EQ(unchanged.level, diagnostic_msgs::DiagnosticStatus::OK);
  EXPECT_EQ(unchanged.values.back().key, "not read: no echo");
}

}  // namespace
}  // namespace alight
