#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "geometry/frames.hpp"
#include "sim/record/fault_injector.hpp"
#include "tests/faults/simulated_truth.hpp"
#ifdef ALIGHT_FAULTS_WITH_NETWORK
#include "infer/network/network_predictor.hpp"
#include "infer/replay/replay.hpp"
#include "tests/support/scratch_folder.hpp"
#endif

namespace alight {
namespace {

using sim::all_faults;
using sim::Fault;
using sim::Messages;
using sim::TimedMessage;

namespace fs = std::filesystem;

constexpr double kFault_s = 4.25;
constexpr double kTimeToNotice_s = 0.5;

/// What a flight came to, from the fault on.
struct Outcome {
  std::optional<double> noticed_s;  ///< after the fault, of the message that made the finding
  HealthFinding finding;            ///< the first one
  std::string state = "ok";         ///< the worst once the fault was noticed in time
  int with_depth = 0;               ///< of those after kTimeToNotice_s
  int late_frames = 0;
  int accepted_before = 0;  ///< in the half second before the fault
  int accepted = 0;
  int unsafe = 0;  ///< of the accepted

  double depth_percent() const { return late_frames > 0 ? 100.0 * with_depth / late_frames : 0; }
};

bool named(const HealthReport& report, const Fault& fault) {
  for (const HealthFinding& finding : report.findings) {
    if (finding.sensor == fault.sensor && finding.fault == fault.finding) return true;
  }
  return false;
}

class Faults : public ::testing::TestWithParam<std::size_t> {
 protected:
  /// Called for the plain tests and for the parametrised ones: flies for the first of them.
  static void SetUpTestSuite() {
    if (truth_) return;
    const test::ScratchFolder folder;
    truth_ = std::make_unique<SimulatedTruth>(folder.path());
    if (const char* path = std::getenv("ALIGHT_FAULT_TABLE")) table_.open(path);
  }

  static std::int64_t fault_ns() { return truth_->begin_ns() + to_nanoseconds(kFault_s); }

  /// Flies `messages` with a depth maker. Frames count from the fault on.
  static Outcome fly(const Messages& messages, const Fault* fault,
                     std::shared_ptr<DepthPredictor> predictor) {
    LandingPipeline pipeline({}, {}, truth_->rig(), std::move(predictor));
    Outcome outcome;
    for (const TimedMessage& timed : messages) {
      for (const FrameReport& frame : pipeline.add(timed.message)) count(frame, outcome);
      if (timed.receive_ns < fault_ns()) {
        EXPECT_EQ(pipeline.health().state, HealthState::kOk) << describe(pipeline.health());
        continue;
      }
      note(pipeline.health(), fault, to_seconds(timed.receive_ns - fault_ns()), outcome);
    }
    for (const FrameReport& frame : pipeline.finish()) count(frame, outcome);
    return outcome;
  }

  static void note(const HealthReport& health, const Fault* fault, double since_s, Outcome& outcome) {
    if (health.state == HealthState::kOk) return;
    const bool right = fault == nullptr || fault->sensor.empty() || named(health, *fault);
    if (!outcome.noticed_s && right) {
      outcome.noticed_s = since_s;
      outcome.finding = health.findings.front();
      for (const HealthFinding& finding : health.findings) {
        if (fault != nullptr && finding.sensor == fault->sensor && finding.fault == fault->finding)
          outcome.finding = finding;
      }
    }
    if (health.state == HealthState::kFailed && since_s < 1.0) outcome.state = "failed";
    if (health.state == HealthState::kDegraded && outcome.state == "ok") outcome.state = "degraded";
  }

  static void count(const FrameReport& frame, Outcome& outcome) {
    const bool accepted = frame.decision.site && frame.decision.site->accepted;
    if (frame.depth.t_ns < fault_ns()) {
      outcome.accepted_before += accepted && frame.depth.t_ns >= fault_ns() - to_nanoseconds(0.5);
      return;
    }
    if (frame.depth.t_ns >= fault_ns() + to_nanoseconds(kTimeToNotice_s)) {
      ++outcome.late_frames;
      outcome.with_depth +=
          frame.depth.source != DepthSource::kNone && frame.health.state != HealthState::kFailed;
    }
    if (!accepted) return;
    ++outcome.accepted;
    outcome.unsafe += truth_->is_safe(frame) ? 0 : 1;
  }

  static void row(const std::string& depth, const std::string& name, const Outcome& outcome) {
    char text[600];
    char noticed[32] = "not";
    if (outcome.noticed_s) std::snprintf(noticed, sizeof noticed, "%.2f s", *outcome.noticed_s);
    std::snprintf(text, sizeof text, "| %s | %s | %s | %s | %s | %.0f %% | %d | %d |\n", depth.c_str(),
                  name.c_str(), noticed,
                  outcome.noticed_s ? (outcome.finding.sensor + " " + outcome.finding.fault).c_str() : "",
                  outcome.state.c_str(), outcome.depth_percent(), outcome.accepted, outcome.unsafe);
    std::printf("%s", text);
    std::fflush(stdout);
    if (table_.is_open()) table_ << text << std::flush;
  }

  static void expect_noticed(const Fault& fault, const std::string& state, const Outcome& outcome) {
    EXPECT_EQ(outcome.unsafe, 0) << "of " << outcome.accepted;
    if (fault.sensor.empty()) return;
    ASSERT_TRUE(outcome.noticed_s) << fault.sensor << " " << fault.finding;
    EXPECT_LE(*outcome.noticed_s, kTimeToNotice_s);
    EXPECT_EQ(outcome.finding.sensor, fault.sensor);
    EXPECT_EQ(outcome.finding.fault, fault.finding);
    EXPECT_EQ(outcome.state, state);
  }

  inline static std::unique_ptr<SimulatedTruth> truth_;
  inline static std::ofstream table_;
};

const Fault& fault_of(std::size_t index) { return all_faults().at(index); }

/// What is left without a network when the LiDAR is out.
std::string lidar_only_state(const Fault& fault) {
  const bool needs_lidar = fault.sensor == "lidar" && fault.finding != "points missing";
  return needs_lidar ? "failed" : fault.state;
}

TEST_F(Faults, AHealthyFlightHasNoFindingAndAcceptsSafeSites) {
  const Outcome outcome = fly(truth_->messages(), nullptr, nullptr);
  row("LiDAR alone", "none", outcome);
  EXPECT_FALSE(outcome.noticed_s) << outcome.finding.sensor << " " << outcome.finding.reason;
  EXPECT_GT(outcome.accepted_before, 2);  // the faults strike while a site is being followed
  EXPECT_GT(outcome.accepted, 10);
  EXPECT_EQ(outcome.unsafe, 0);
  EXPECT_EQ(outcome.depth_percent(), 100);
}

/// From a second and a half before the fault on, and one in every so many images.
[[maybe_unused]] Messages shortened(const Messages& flight, std::int64_t fault_ns, int image_step) {
  Messages few;
  int images = 0;
  for (const TimedMessage& timed : flight) {
    const bool image = std::holds_alternative<StereoFrame>(timed.message);
    const bool early = timed.receive_ns < fault_ns - to_nanoseconds(image ? 0.7 : 1.6);
    if (early || (image && images++ % image_step != 0)) continue;
    few.push_back(timed);
  }
  return few;
}

TEST_P(Faults, LidarAlone) {
  const Fault& fault = fault_of(GetParam());
  Messages flight = sim::inject(fault, truth_->messages(), fault_ns());
#ifdef ALIGHT_FAULTS_SHORT
  flight = shortened(flight, fault_ns(), 1);
#endif
  const Outcome outcome = fly(flight, &fault, nullptr);
  row("LiDAR alone", fault.name, outcome);
  expect_noticed(fault, lidar_only_state(fault), outcome);
}

#ifdef ALIGHT_FAULTS_WITH_NETWORK
/// A network costs a quarter of a second a frame: by default it flies those faults that reach it, at every other image.
bool reaches_the_network(const Fault& fault) {
  for (const char* name : {"camera black", "cameras swapped", "LiDAR lost", "LiDAR mirrored left-right"}) {
    if (fault.name == name) return true;
  }
  return false;
}

bool thorough() { return std::getenv("ALIGHT_FAULTS_THOROUGH") != nullptr; }

int network_image_step() { return thorough() ? 1 : 2; }

std::shared_ptr<DepthPredictor> shipped_network(const Rig& rig) {
  return make_network_predictor(fs::path(ALIGHT_SOURCE_DIR) / "models" / "weights" / "default.pt",
                                engine_rig({}, rig), {});
}

TEST_F(Faults, AHealthyFlightWithTheShippedNetwork) {
  const Outcome outcome = fly(shortened(truth_->messages(), fault_ns(), network_image_step()), nullptr,
                              shipped_network(truth_->rig()));
  row("network", "none", outcome);
  EXPECT_FALSE(outcome.noticed_s) << outcome.finding.sensor << " " << outcome.finding.reason;
  EXPECT_EQ(outcome.unsafe, 0);
  EXPECT_GT(outcome.depth_percent(), 90);
}

TEST_P(Faults, ShippedNetwork) {
  const Fault& fault = fault_of(GetParam());
  if (!thorough() && !reaches_the_network(fault)) {
    GTEST_SKIP() << "flown by scripts/bench/faults.sh (ALIGHT_FAULTS_THOROUGH=1)";
  }
  const Messages flight =
      shortened(sim::inject(fault, truth_->messages(), fault_ns()), fault_ns(), network_image_step());
  const Outcome outcome = fly(flight, &fault, shipped_network(truth_->rig()));
  row("network", fault.name, outcome);
  expect_noticed(fault, fault.state, outcome);
}
#endif

std::string test_name(const ::testing::TestParamInfo<std::size_t>& info) {
  std::string name = fault_of(info.param).name;
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  return name;
}

TEST(FaultNames, StandInListsSeparatedByCommas) {
  for (const Fault& fault : all_faults()) EXPECT_EQ(fault.name.find(','), std::string::npos) << fault.name;
}

INSTANTIATE_TEST_SUITE_P(All, Faults, ::testing::Range<std::size_t>(0, all_faults().size()), test_name);

}  // namespace
}  // namespace alight
