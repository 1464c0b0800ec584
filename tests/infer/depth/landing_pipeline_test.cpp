#include "infer/depth/landing_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "foundation/config_reader.hpp"
#include "tests/infer/fakes.hpp"
#include "tests/infer/landing/landing_scenes.hpp"

namespace alight {
namespace {

using fakes::kStart_ns;

constexpr double kAbove_m = 12.0;

DepthEngineConfig small_engine() {
  DepthEngineConfig config;
  config.width_px = 160;
  config.height_px = 144;
  return config;
}

std::vector<FrameReport> fly(const std::vector<LogMessage>& messages, std::shared_ptr<DepthPredictor> net,
                             const LandingConfig& landing = {}) {
  LandingPipeline pipeline(small_engine(), landing, fakes::small_rig(), std::move(net));
  std::vector<FrameReport> frames;
  const auto take = [&](std::vector<FrameReport> more) {
    for (FrameReport& frame : more) frames.push_back(std::move(frame));
  };
  for (const LogMessage& message : messages) take(pipeline.add(message));
  take(pipeline.finish());
  return frames;
}

TEST(LandingPipeline, LevelGroundIsAcceptedInTheFifthFrame) {
  fakes::LevelWorld world(kAbove_m);
  const auto frames =
      fly(fakes::flight(world, {2.0}), std::make_shared<fakes::FakePredictor>([](int) { return kAbove_m; }));
  ASSERT_GT(frames.size(), 20U);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    ASSERT_TRUE(frames[i].decision.site) << i << " " << frames[i].site_reason();
    EXPECT_EQ(frames[i].decision.site->accepted, i >= 4) << i;
    // The camera sits at the first fix; the ground is kAbove_m below.
    EXPECT_NEAR(frames[i].decision.site->p_world.z(), -kAbove_m, 0.05);
    EXPECT_NEAR(frames[i].image_site->radius_px, frames[i].decision.site->circle.radius_px, 1.0);
  }
}

TEST(LandingPipeline, BothDecisionsAreMadeAndTheConfiguredOneIsFollowed) {
  fakes::LevelWorld world(kAbove_m);
  for (const SiteSource source : {SiteSource::kFrame, SiteSource::kFused, SiteSource::kBoth}) {
    LandingConfig landing;
    landing.site_source = source;
    const auto frames = fly(fakes::flight(world, {1.0}),
                            std::make_shared<fakes::FakePredictor>([](int) { return kAbove_m; }), landing);
    ASSERT_GT(frames.size(), 8U);
    for (const FrameReport& frame : frames) {
      ASSERT_TRUE(frame.selection && frame.fused);
      EXPECT_EQ(&frame.decisive(), source == SiteSource::kFused ? &*frame.fused : &*frame.selection);
    }
    ASSERT_TRUE(frames.back().decision.site) << frames.back().site_reason();
    EXPECT_TRUE(frames.back().decision.site->accepted);
    EXPECT_NEAR(frames.back().decision.site->p_world.z(), -kAbove_m, 0.05);
  }
  LandingConfig forgetful;
  forgetful.fuse = false;
  const auto frames = fly(fakes::flight(world, {0.5}),
                          std::make_shared<fakes::FakePredictor>([](int) { return kAbove_m; }), forgetful);
  EXPECT_FALSE(frames.front().fused);
  EXPECT_THROW(parse_config<LandingConfig>("{fuse: false, site_source: fused}", "x"), ConfigError);
  EXPECT_THROW(parse_config<LandingConfig>("{fuse: false, site_source: both}", "x"), ConfigError);
  for (const std::string source : {"fused", "both"}) {
    EXPECT_THROW(
        parse_config<LandingConfig>("{site_source: " + source + ", selection: {method: derivatives}}", "x"),
        ConfigError);
  }
}

TEST(LandingConfig, TheCautiousOneKeepsFartherFromAStone) {
  const std::string configs = std::string(ALIGHT_SOURCE_DIR) + "/configs/landing/";
  const auto cautious = load_config<LandingConfig>(configs + "cautious.yaml");
  const auto normal = load_config<LandingConfig>(configs + "default.yaml");
  const PinholeIntrinsics k = scenes::camera_of(352, 352);
  cv::Mat depth = scenes::level_ground(k, 20);
  scenes::change(depth, k, 20, [](double x, double y) { return std::hypot(x, y) < 0.5; }, 19.5F);
  const Eigen::Matrix3d R = scenes::attitude(0, 0);
  const cv::Mat far_safe = SiteSelector(cautious.selection, k).select(depth, R).safe;
  const cv::Mat near_safe = SiteSelector(normal.selection, k).select(depth, R).safe;
  EXPECT_GT(cv::countNonZero(near_safe & ~far_safe), 100);
  EXPECT_EQ(cv::countNonZero(far_safe & ~near_safe), 0);
}

TEST(LandingPipeline, NoTrustedDepthNoSiteAndWanderAfterFiveSeconds) {
  fakes::LevelWorld world(kAbove_m);
  fakes::FlightPlan plan;
  plan.duration_s = 7;
  plan.image_hz = 4;
  plan.lidar_begin_s = 1e6;
  plan.right = false;
  const auto frames =
      fly(fakes::flight(world, plan), std::make_shared<fakes::FakePredictor>([](int) { return kAbove_m; }));
  for (const FrameReport& frame : frames) {
    EXPECT_FALSE(frame.decision.site);
    EXPECT_EQ(frame.site_reason().rfind("no trusted depth", 0), 0U);
    EXPECT_EQ(frame.decision.wander,
              frame.depth.t_ns - frames.front().depth.t_ns > 5 * kNanosecondsPerSecond);
  }
}

/// The camera falls silent after a second: every LiDAR packet makes a frame, and the site stays accepted.
TEST(LandingPipeline, WithoutImagesTheLidarGoesOnAlone) {
  fakes::LevelWorld world(kAbove_m);
  std::vector<LogMessage> messages = fakes::flight(world, {3.0});
  const std::int64_t lost_ns = kStart_ns + to_nanoseconds(1.5);
  messages.erase(std::remove_if(messages.begin(), messages.end(),
                                [&](const LogMessage& message) {
                                  const auto* frame = std::get_if<StereoFrame>(&message);
                                  return frame != nullptr && frame->t_ns > lost_ns;
                                }),
                 messages.end());
  const auto frames = fly(messages, std::make_shared<fakes::FakePredictor>([](int) { return kAbove_m; }));
  int blind = 0;
  for (const FrameReport& frame : frames) {
    if (frame.depth.t_ns <= lost_ns) continue;
    ++blind;
    EXPECT_EQ(frame.depth.source, DepthSource::kFallback) << frame.depth.reason;
    EXPECT_EQ(frame.depth.predictions, 0);
    EXPECT_EQ(frame.health.state, HealthState::kDegraded);
    ASSERT_TRUE(frame.decision.site) << frame.site_reason();
    EXPECT_TRUE(frame.decision.site->accepted);
  }
  EXPECT_GE(blind, 10);
}

TEST(LandingPipeline, AFailedHealthVetoesTheSiteAndSaysSo) {
  fakes::LevelWorld world(kAbove_m);
  std::vector<LogMessage> messages = fakes::flight(world, {2.5});
  const std::int64_t jump_ns = kStart_ns + to_nanoseconds(1.5);
  for (LogMessage& message : messages) {
    auto* sample = std::get_if<PositionSample>(&message);
    if (sample != nullptr && sample->t_ns >= jump_ns)
      std::get<GeodeticPosition>(sample->position).altitude_m += 5;
  }
  const auto frames = fly(messages, std::make_shared<fakes::FakePredictor>([](int) { return kAbove_m; }));
  int vetoed = 0;
  for (const FrameReport& frame : frames) {
    if (frame.health.state != HealthState::kFailed) continue;
    ++vetoed;
    EXPECT_FALSE(frame.decision.site);
    if (frame.depth.depth_m.empty()) continue;
    EXPECT_EQ(frame.site_reason().rfind("sensors failed: ", 0), 0U) << frame.site_reason();
    EXPECT_NE(frame.site_reason().find("position jump"), std::string::npos) << frame.site_reason();
  }
  EXPECT_GT(vetoed, 15);  // 20 Hz for a second
}

TEST(InCameraImage, ALevelCircleIsSeenWhereItsCentreIs) {
  const PinholeIntrinsics k{440, 440, 175.5, 175.5, 352, 352};
  LandingSite site;
  site.p_level = {1.0, -2.0, 20.0};
  site.depth_m = 20;
  site.radius_m = 3;
  const ImageSite level = in_camera_image(site, Eigen::Matrix3d::Identity(), k);
  EXPECT_NEAR(level.u_px, 175.5 + 22, 1e-9);
  EXPECT_NEAR(level.v_px, 175.5 - 44, 1e-9);
  EXPECT_NEAR(level.radius_px, 66, 1e-9);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()).toRotationMatrix();
  const ImageSite turned = in_camera_image(site, R, k);
  const Eigen::Vector3d p_camera = R.transpose() * site.p_level;
  EXPECT_NEAR(turned.u_px, 175.5 + 440 * p_camera.x() / p_camera.z(), 1e-9);
  EXPECT_NEAR(turned.radius_px, 440 * 3 / p_camera.z(), 1e-9);
}

}  // namespace
}  // namespace alight
