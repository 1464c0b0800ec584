#pragma once

#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "geometry/rig/stereo_rectification.hpp"
#include "infer/autopilot/autopilot_config.hpp"
#include "infer/autopilot/mavlink_messages.hpp"
#include "infer/autopilot/rate_limit.hpp"
#include "infer/autopilot/transport.hpp"
#include "infer/onboard/frame_sink.hpp"
#include "infer/onboard/mode_switch.hpp"
#include "infer/onboard/steady_time.hpp"

namespace alight {

/// How the link to the autopilot is doing.
struct AutopilotStatistics {
  std::int64_t targets = 0;                      ///< landing targets sent
  std::int64_t heartbeats = 0;                   ///< heartbeats sent
  std::int64_t failures = 0;                     ///< messages that could not be sent
  std::string last_failure;                      ///< cause and cure; empty while the last message went out
  std::map<std::string, std::int64_t> withheld;  ///< results not sent: reason -> count
};

/// Tells the autopilot over MAVLink 2 where to land: LANDING_TARGET for results that reason_to_withhold lets through,
/// no more often than max_rate_hz, and a HEARTBEAT every second whatever happens. Only the newest target waits to be
/// sent. A result's age is counted from its image to the newest stamped message, plus the time since that came; what is
/// too old when its turn comes, or finds the switch on manual, is not sent.
///
/// All that may take time is done on a thread of its own: the engine's never waits, and nothing is thrown at it. A
/// connection that fails is counted, warned about now and then, and tried again every second.
class AutopilotLink : public FrameSink {
 public:
  /// @param rig as the engine sees it: LandingPipeline::engine().rig()  @param mode outlives the link
  /// @throws ConfigError if `connection` is set and is none
  AutopilotLink(const AutopilotConfig& config, const RectifiedRig& rig, const ModeSwitch& mode);
  /// Ends the thread; waits for a look-up of the host's name that is under way.
  ~AutopilotLink() override;

  void on_message(const LogMessage& message) override;
  void on_frame(const FrameReport& frame) override;

  /// Any thread.
  AutopilotStatistics statistics() const;

 private:
  struct Waiting {
    LandingTarget target;
    SteadyTime expires;
  };

  double age_s(std::int64_t t_ns, SteadyTime now) const;
  void withhold(const char* reason);
  void run();
  void send_heartbeat();
  void send_target(const Waiting& waiting);
  bool send(const MavlinkMessage& message);
  void connect();
  void report_failure(const std::string& what);

  const AutopilotConfig config_;
  const Eigen::Isometry3d T_camera_imu_;
  const ModeSwitch& mode_;

  // of the engine's thread
  std::optional<std::int64_t> newest_ns_;  // stamp of the newest message
  SteadyTime newest_came_;
  RateLimit target_rate_;

  // of the link's thread
  MavlinkFramer framer_;
  std::unique_ptr<Transport> transport_;
  std::optional<SteadyTime> tried_;  // to connect
  RateLimit warning_rate_;
  bool warned_ = false;

  mutable std::mutex mutex_;  // for what follows
  std::condition_variable changed_;
  std::optional<Waiting> waiting_;
  AutopilotStatistics statistics_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace alight
