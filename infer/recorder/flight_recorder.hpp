#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>

#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "infer/onboard/frame_sink.hpp"
#include "infer/recorder/segment_log.hpp"

namespace alight {

/// What a flight recorder keeps.
struct RecorderConfig {
  double segment_mb = 16;  ///< a file that has grown beyond is followed by the next
  double total_mb = 500;   ///< of all files; the oldest is deleted first
  int image_every = 20;  ///< pictures every so many results, and at every change of state; 0: at changes only
  int image_width_px = 176;  ///< of the pictures
  int jpeg_quality = 80;     ///< of the left image
  int max_waiting = 64;      ///< results that may wait for the disk; the oldest goes when another comes
  double sync_s = 1.0;       ///< what is older than this survives the loss of power
};
void bind(Binder& b, RecorderConfig& c);

/// The limits that decisions were made by: the explanation needs them.
struct RecordedSettings {
  int crop_x_px = 0;  ///< of the results' images in the rectified left image
  int crop_y_px = 0;
  DepthEngineConfig engine;
  LandingConfig landing;
};
void bind(Binder& b, RecordedSettings& c);

/// How a recorder is doing.
struct RecorderStatistics {
  std::int64_t records = 0;  ///< on the disk
  std::int64_t lost = 0;     ///< results and changes left out: the disk was too slow or full
};

/// Every result and every change of health in a crash-safe log (SegmentWriter), with small pictures now and then: what is
/// needed to say afterwards why a site was chosen or not (explain()). All work is done on a thread of its own; a disk that
/// is slow or full costs records, never time in flight, and is reported once.
class FlightRecorder : public FrameSink {
 public:
  /// @throws DataError if the folder cannot be made
  FlightRecorder(const RecorderConfig& config, const std::filesystem::path& folder,
                 const RecordedSettings& settings);
  /// Writes what waits.
  ~FlightRecorder() override;

  void on_frame(const FrameReport& frame) override { push(frame); }
  void on_health(const HealthReport& health) override;
  void on_message(const LogMessage& message) override;

  RecorderStatistics statistics() const;

 private:
  struct HealthChange {
    std::int64_t t_ns;
    HealthReport health;
  };
  using Item = std::variant<FrameReport, HealthChange>;

  void push(Item item);
  void run();
  void write(const FrameReport& frame);
  void write(const HealthChange& change);
  void write_pictures(const FrameReport& frame);
  void append(RecordKind kind, std::int64_t t_ns, std::string content);
  bool state_changed(const FrameReport& frame);

  RecorderConfig config_;
  cv::Rect crop_;
  SegmentWriter log_;
  std::int64_t latest_ns_ = 0;  // of the messages; the engine's thread alone
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Item> waiting_;
  RecorderStatistics statistics_;
  bool closing_ = false;
  // The recorder's thread alone:
  std::int64_t results_ = 0;
  std::string last_state_;
  bool disk_failed_ = false;
  std::thread thread_;
};

}  // namespace alight
