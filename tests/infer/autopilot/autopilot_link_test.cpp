#include "infer/autopilot/autopilot_link.hpp"

#include <filesystem>
#include <functional>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "geometry/frames.hpp"
#include "infer/autopilot/landing_target.hpp"
#include "tests/infer/autopilot/autopilot_reports.hpp"
#include "tests/infer/autopilot/receivers.hpp"
#include "tests/support/scratch_folder.hpp"

namespace alight {
namespace {

using receivers::Bytes;
using receivers::Frame;
using reports::confirmed;
using reports::kStart_ns;
using ::testing::HasSubstr;

constexpr int kHeartbeat = 0;
constexpr int kLandingTarget = 149;

AutopilotConfig config_for(const std::string& connection) {
  AutopilotConfig config;
  config.connection = connection;
  config.max_age_s = 10;  // tests may run on a busy computer
  return config;
}

AttitudeSample attitude_at(double s) {
  AttitudeSample sample;
  sample.t_ns = kStart_ns + to_nanoseconds(s);
  return sample;
}

bool wait_until(const std::function<bool()>& condition) {
  const SteadyTime begin = steady_now();
  while (!condition()) {
    if (milliseconds(begin, steady_now()) > receivers::kPatience_ms) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

/// The next frame with this id; fails where none comes.
Frame next(const receivers::UdpPort& port, int id) {
  const SteadyTime begin = steady_now();
  while (milliseconds(begin, steady_now()) < receivers::kPatience_ms) {
    const Bytes bytes = port.receive();
    if (bytes.empty()) break;
    if (Frame frame = receivers::take_apart(bytes); frame.id == id) return frame;
  }
  ADD_FAILURE() << "no message " << id;
  return {};
}

/// A link to a UDP port of this computer.
struct UdpLink {
  explicit UdpLink(AutopilotConfig config = {}, FlightMode flight_mode = FlightMode::kAutomatic)
      : mode(flight_mode) {
    config.connection = port.connection();
    link = std::make_unique<AutopilotLink>(config, reports::down_looking_rig(), mode);
  }
  std::int64_t withheld(const std::string& reason) const {
    const auto all = link->statistics().withheld;
    const auto found = all.find(reason);
    return found == all.end() ? 0 : found->second;
  }

  receivers::UdpPort port;
  ModeSwitch mode;
  std::unique_ptr<AutopilotLink> link;
};

TEST(AutopilotLink, SendsAConfirmedSite) {
  AutopilotConfig config = config_for("");
  config.system_id = 7;
  config.component_id = 42;
  const UdpLink udp(config);
  udp.link->on_message(attitude_at(0.1));
  udp.link->on_frame(confirmed());
  const Frame frame = next(udp.port, kLandingTarget);
  EXPECT_EQ(frame.system_id, 7);
  EXPECT_EQ(frame.component_id, 42);
  const FrameReport report = confirmed();
  EXPECT_EQ(frame.payload,
            encode(landing_target(*report.decision.site, kStart_ns, *report.depth.T_world_camera,
                                  reports::down_looking_rig().T_camera_imu))
                .payload);
  EXPECT_TRUE(wait_until([&] { return udp.link->statistics().targets == 1; }));
}

TEST(AutopilotLink, BeatsEverySecondWithoutAnyResult) {
  const SteadyTime begin = steady_now();
  const UdpLink udp;
  const Frame first = next(udp.port, kHeartbeat);
  EXPECT_EQ(first.payload, encode(Heartbeat{}).payload);
  EXPECT_EQ(next(udp.port, kHeartbeat).sequence, first.sequence + 1);
  EXPECT_EQ(next(udp.port, kHeartbeat).sequence, first.sequence + 2);
  EXPECT_GT(milliseconds(begin, steady_now()), 1900);
}

TEST(AutopilotLink, BeatsInManualModeButSendsNoSite) {
  const UdpLink udp(config_for(""), FlightMode::kManual);
  udp.link->on_message(attitude_at(0.1));
  udp.link->on_frame(confirmed());
  EXPECT_EQ(udp.withheld("manual mode"), 1);
  next(udp.port, kHeartbeat);
  next(udp.port, kHeartbeat);
  EXPECT_EQ(udp.link->statistics().targets, 0);
}

TEST(AutopilotLink, FollowsTheModeSwitch) {
  UdpLink udp(config_for(""), FlightMode::kManual);
  udp.link->on_message(attitude_at(0.1));
  udp.link->on_frame(confirmed());
  udp.mode.set(FlightMode::kAutomatic);
  udp.link->on_frame(confirmed(kStart_ns + 1000));
  next(udp.port, kLandingTarget);
  EXPECT_EQ(udp.withheld("manual mode"), 1);
}

TEST(AutopilotLink, WithholdsWhatTheRuleForbids) {
  const UdpLink udp(config_for(""));
  udp.link->on_message(attitude_at(0.1));
  FrameReport frame = confirmed();
  frame.decision.site->accepted = false;
  udp.link->on_frame(frame);
  EXPECT_EQ(udp.withheld("landing site not confirmed"), 1);
  EXPECT_EQ(udp.link->statistics().targets, 0);
}

TEST(AutopilotLink, AgeIsCountedToTheNewestStamp) {
  AutopilotConfig config = config_for("");
  const UdpLink udp(config);
  udp.link->on_message(attitude_at(10.5));
  udp.link->on_message(attitude_at(1.0));  // late in coming: the newest stays
  udp.link->on_frame(confirmed());
  EXPECT_EQ(udp.withheld("result too old"), 1);
  udp.link->on_frame(confirmed(kStart_ns + to_nanoseconds(10.4)));
  next(udp.port, kLandingTarget);
}

TEST(AutopilotLink, AHeightHasNoStampToCountTo) {
  const UdpLink udp(config_for(""));
  udp.link->on_message(attitude_at(0.1));
  HeightSample height;
  height.t_ns = kStart_ns + 1000 * kNanosecondsPerSecond;  // the recorder's clock
  udp.link->on_message(height);
  udp.link->on_frame(confirmed());
  next(udp.port, kLandingTarget);
}

TEST(AutopilotLink, TheTimeThatWorkTookCountsToo) {
  AutopilotConfig config;
  config.max_age_s = 0.1;
  const UdpLink udp(config);
  udp.link->on_message(attitude_at(0));
  std::this_thread::sleep_for(std::chrono::milliseconds(120));  // the engine works on it
  udp.link->on_frame(confirmed());
  EXPECT_EQ(udp.withheld("result too old"), 1);
}

TEST(AutopilotLink, WithoutAnyStampNothingIsKnownToBeFresh) {
  const UdpLink udp(config_for(""));
  udp.link->on_frame(confirmed());
  EXPECT_EQ(udp.withheld("result too old"), 1);
}

TEST(AutopilotLink, KeepsToTheRate) {
  AutopilotConfig config = config_for("");
  config.max_rate_hz = 0.001;  // once in a quarter of an hour
  const UdpLink udp(config);
  udp.link->on_message(attitude_at(0));
  for (int i = 0; i < 20; ++i) udp.link->on_frame(confirmed(kStart_ns + i));
  EXPECT_EQ(udp.withheld("max_rate_hz"), 19);
  next(udp.port, kLandingTarget);
  EXPECT_TRUE(wait_until([&] { return udp.link->statistics().targets == 1; }));
}

TEST(AutopilotLink, WhatWaitedIsNotSentOnceAPersonFlies) {
  const receivers::SerialPort port;
  port.jam();
  ModeSwitch mode(FlightMode::kAutomatic);
  AutopilotConfig config = config_for(port.connection());
  config.max_rate_hz = 1000;
  AutopilotLink link(config, reports::down_looking_rig(), mode);
  link.on_message(attitude_at(0));
  // Once its thread is busy with another message, or slow to wake, the site waits while the mode changes.
  EXPECT_TRUE(wait_until([&] {
    mode.set(FlightMode::kAutomatic);
    link.on_frame(confirmed());
    mode.set(FlightMode::kManual);
    return link.statistics().withheld["manual mode"] > 0;
  }));
  EXPECT_EQ(link.statistics().targets, 0);
}

TEST(AutopilotLink, SendsOverASerialPort) {
  const receivers::SerialPort port;
  const ModeSwitch mode(FlightMode::kAutomatic);
  AutopilotLink link(config_for(port.connection()), reports::down_looking_rig(), mode);
  const Frame heartbeat = receivers::take_apart(port.receive(21));
  EXPECT_EQ(heartbeat.id, kHeartbeat);
  EXPECT_EQ(heartbeat.sequence, 0);
  link.on_message(attitude_at(0));
  link.on_frame(confirmed());
  const Frame target = receivers::take_apart(port.receive(72));
  EXPECT_EQ(target.id, kLandingTarget);
  EXPECT_EQ(target.sequence, 1);
}

TEST(AutopilotLink, WaitsForASerialPortToBePluggedIn) {
  const test::ScratchFolder folder;
  const auto device = folder / "port";
  const ModeSwitch mode(FlightMode::kAutomatic);
  AutopilotLink link(config_for("serial:" + device.string() + ":115200"), reports::down_looking_rig(), mode);
  ASSERT_TRUE(wait_until([&] { return link.statistics().failures > 0; }));
  EXPECT_THAT(link.statistics().last_failure, HasSubstr("plug the cable in"));
  const receivers::SerialPort port;
  std::filesystem::create_symlink(port.device(), device);
  EXPECT_EQ(receivers::take_apart(port.receive(21)).id, kHeartbeat);
  EXPECT_TRUE(wait_until([&] { return link.statistics().last_failure.empty(); }));
}

TEST(AutopilotLink, APulledCableNeitherThrowsNorStopsTheEngine) {
  receivers::SerialPort port;
  const ModeSwitch mode(FlightMode::kAutomatic);
  AutopilotConfig config = config_for(port.connection());
  config.max_rate_hz = 100;
  AutopilotLink link(config, reports::down_looking_rig(), mode);
  ASSERT_FALSE(port.receive(21).empty());
  port.unplug();
  link.on_message(attitude_at(0));
  EXPECT_TRUE(wait_until([&] {
    link.on_frame(confirmed());
    return link.statistics().failures >= 3;
  }));
  EXPECT_FALSE(link.statistics().last_failure.empty());
}

TEST(AutopilotLink, AnUnreachableHostNeitherThrowsNorStopsTheEngine) {
  const ModeSwitch mode(FlightMode::kAutomatic);
  AutopilotLink link(config_for("udp:256.256.256.256:14550"), reports::down_looking_rig(), mode);
  ASSERT_TRUE(wait_until([&] { return link.statistics().failures > 0; }));
  EXPECT_THAT(link.statistics().last_failure, HasSubstr("the host is not found"));
}

/// How long the engine waits for the link at most in 1.2 s, longer than from one try to open a port to the next.
double longest_wait_ms(AutopilotLink& link) {
  double longest_ms = 0;
  for (int i = 0; i < 120; ++i) {
    const SteadyTime begin = steady_now();
    link.on_frame(confirmed(kStart_ns + i));
    longest_ms = std::max(longest_ms, milliseconds(begin, steady_now()));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return longest_ms;
}

TEST(AutopilotLink, AJammedPortDoesNotHoldTheEngineUp) {
  const receivers::SerialPort port;
  port.jam();  // one send takes a fifth of a second until it is given up
  const ModeSwitch mode(FlightMode::kAutomatic);
  AutopilotConfig config = config_for(port.connection());
  config.max_rate_hz = 100;
  AutopilotLink link(config, reports::down_looking_rig(), mode);
  link.on_message(attitude_at(0));
  // A busy computer may hold this thread up now and then; the port would do so every time.
  bool held_up = true;
  for (int i = 0; i < 30 && held_up; ++i) held_up = longest_wait_ms(link) >= 150;
  EXPECT_FALSE(held_up);
  EXPECT_GT(link.statistics().failures, 0);
  EXPECT_EQ(link.statistics().targets, 0);
}

TEST(AutopilotLink, SendsNothingWithoutAConnection) {
  const ModeSwitch mode(FlightMode::kAutomatic);
  AutopilotLink link(AutopilotConfig{}, reports::down_looking_rig(), mode);
  link.on_message(attitude_at(0));
  link.on_frame(confirmed());
  EXPECT_EQ(link.statistics().targets + link.statistics().heartbeats + link.statistics().failures, 0);
}

TEST(AutopilotLink, RefusesAConnectionThatIsNone) {
  const ModeSwitch mode;
  EXPECT_THROW(AutopilotLink(config_for("tcp:host:5760"), reports::down_looking_rig(), mode), ConfigError);
}

}  // namespace
}  // namespace alight
