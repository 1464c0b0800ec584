#include "infer/autopilot/send_rule.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/infer/autopilot/autopilot_reports.hpp"

namespace alight {
namespace {

const char* reason(const FrameReport& frame, FlightMode mode = FlightMode::kAutomatic, double age_s = 0.1) {
  return reason_to_withhold(frame, mode, age_s, 0.5);
}

TEST(SendRule, AConfirmedSiteIsSent) { EXPECT_EQ(reason(reports::confirmed()), nullptr); }

TEST(SendRule, NothingIsSentInManualMode) {
  EXPECT_STREQ(reason(reports::confirmed(), FlightMode::kManual), "manual mode");
}

TEST(SendRule, NothingIsSentWhenTheSensorsFailed) {
  FrameReport frame = reports::confirmed();
  frame.health.state = HealthState::kFailed;
  EXPECT_STREQ(reason(frame), "sensors failed");
  frame.health.state = HealthState::kDegraded;  // the other sensors carry on
  EXPECT_EQ(reason(frame), nullptr);
}

TEST(SendRule, NothingIsSentWithoutTrustedDepth) {
  FrameReport frame = reports::confirmed();
  frame.depth.source = DepthSource::kNone;
  EXPECT_STREQ(reason(frame), "no trusted depth");
  for (const DepthSource source : {DepthSource::kImage, DepthSource::kLidar, DepthSource::kFallback}) {
    frame.depth.source = source;
    EXPECT_EQ(reason(frame), nullptr) << name(source);
  }
}

TEST(SendRule, NothingIsSentWithoutASite) {
  FrameReport frame = reports::confirmed();
  frame.decision.site.reset();
  EXPECT_STREQ(reason(frame), "no landing site");
}

TEST(SendRule, NothingIsSentBeforeTheSiteIsConfirmed) {
  FrameReport frame = reports::confirmed();
  frame.decision.site->accepted = false;
  EXPECT_STREQ(reason(frame), "landing site not confirmed");
}

TEST(SendRule, NothingIsSentWithoutAPose) {
  FrameReport frame = reports::confirmed();
  frame.depth.T_world_camera.reset();
  EXPECT_STREQ(reason(frame), "no pose");
}

TEST(SendRule, NothingIsSentThatIsNoNumber) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  FrameReport site = reports::confirmed();
  site.decision.site->p_world.z() = kNan;
  EXPECT_STREQ(reason(site), "position not finite");
  FrameReport pose = reports::confirmed();
  pose.depth.T_world_camera->translation().x() = kNan;
  EXPECT_STREQ(reason(pose), "position not finite");
}

TEST(SendRule, NothingIsSentThatIsTooOld) {
  EXPECT_EQ(reason(reports::confirmed(), FlightMode::kAutomatic, 0.5), nullptr);
  EXPECT_STREQ(reason(reports::confirmed(), FlightMode::kAutomatic, 0.51), "result too old");
  EXPECT_STREQ(reason(reports::confirmed(), FlightMode::kAutomatic, std::numeric_limits<double>::quiet_NaN()),
               "result too old");
}

}  // namespace
}  // namespace alight
