#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "foundation/binder_fwd.hpp"
#include "infer/onboard/engine_runner.hpp"
#include "infer/onboard/frame_sink.hpp"
#include "infer/onboard/mode_switch.hpp"
#include "infer/web/shown_frame.hpp"

namespace alight {

/// Where the ground-station page is served, and to whom.
struct GroundStationConfig {
  std::string address = ":8080";     ///< host:port; without a host 127.0.0.1, with port 0 a free one
  std::optional<std::string> token;  ///< who has it may switch the mode; required to serve other computers
  double max_rate_hz = 10;           ///< frames shown in a second, however many watch
  int max_connections = 32;          ///< a viewer has one or two; more are turned away
  int jpeg_quality = 80;
};
void bind(Binder& b, GroundStationConfig& c);

/// A page that shows a flight as it happens, and the switch between automatic and manual mode (docs/ground_station.md).
/// The engine's thread only leaves its results here; pictures are drawn when somebody looks, once for all viewers, on
/// threads of the lowest priority.
class GroundStation : public FrameSink {
 public:
  /// Starts to serve. `mode` outlives this.
  /// @param crop of the results' images (DepthEngine::crop). @param confirm_frames SiteTrackerConfig::confirm_frames
  /// @throws ConfigError (a malformed address, a short token, other computers served without a token), DataError (the
  /// address cannot be had)
  GroundStation(const GroundStationConfig& config, ModeSwitch& mode, const cv::Rect& crop,
                int confirm_frames);
  /// Ends every connection.
  ~GroundStation() override;

  void on_message(const LogMessage& message) override;
  void on_frame(const FrameReport& frame) override;

  /// Where queue, latency and losses are asked for, from any thread, at most ten times a second. Nothing calls
  /// `statistics` any more once another (or an empty one) is set: do so before the runner goes.
  void set_statistics(std::function<RunnerStatistics()> statistics);

  /// For a browser, "http://127.0.0.1:8080/".
  const std::string& url() const;
  /// As configured, else a random one.
  const std::string& token() const;

 private:
  class Site;
  std::unique_ptr<Site> site_;
};

}  // namespace alight
