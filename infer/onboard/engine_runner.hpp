#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "infer/depth/landing_pipeline.hpp"
#include "infer/onboard/frame_sink.hpp"
#include "infer/onboard/message_queue.hpp"
#include "infer/onboard/stage_queue.hpp"

namespace alight {

/// How a live run is doing.
struct RunnerStatistics {
  std::int64_t images = 0;                      ///< results so far
  std::map<std::string, std::int64_t> dropped;  ///< messages and points left out: reason -> count
  std::size_t queued = 0;                       ///< messages waiting now
  /// From the image's arrival in the queue to its result, on this computer's clock.
  double last_latency_ms = 0;
  double max_latency_ms = 0;
  static constexpr std::size_t kLatencySteps = 2000;  ///< of a millisecond
  std::array<std::int64_t, kLatencySteps>
      latencies{};  ///< results by latency; the last step holds all beyond

  void count_latency(double latency_ms);
  /// The latency that a share of the results did not exceed, to the millisecond above; 0 without results.
  double latency_ms(double share) const;
};

/// The pipeline's two stages in threads of their own, so that one looks for a site while the other works on the next
/// image: what a live node, the ground station and a replay in real time run. Messages go in from any thread; results go
/// to the sinks, all on one thread. The same messages give the same results as LandingPipeline called directly, as long as
/// none is pushed out of the queue.
class EngineRunner {
 public:
  /// Starts the threads. @param sinks outlive the runner
  EngineRunner(const MessageQueueConfig& queue, std::unique_ptr<LandingPipeline> pipeline,
               std::vector<FrameSink*> sinks);
  EngineRunner(const EngineRunner&) = delete;
  EngineRunner& operator=(const EngineRunner&) = delete;
  /// Ends the threads after what they have in work; what waits is lost.
  ~EngineRunner();

  /// Any thread; never waits.
  void push(LogMessage message) { queue_.push(std::move(message)); }
  /// Works off what waits, gives every image its result and ends the threads.
  /// @throws what the pipeline or a sink threw on its thread
  void finish();
  /// The engine or a sink has failed; finish() says why.
  bool failed() const;

  RunnerStatistics statistics() const;

 private:
  void make_depth();
  void make_sites();
  void pass_on(std::vector<SensedDepth> depths);
  void deliver(StageEvent event);
  void note_arrival(const MessageQueue::Item& item);
  void fail(std::exception_ptr failure);

  MessageQueue queue_;
  StageQueue stages_;
  std::unique_ptr<LandingPipeline> pipeline_;
  std::vector<FrameSink*> sinks_;
  // The depth thread's own:
  HealthReport told_;                            // the health that the sinks know
  std::map<std::int64_t, SteadyTime> arrivals_;  // of images without a result yet, by their time

  mutable std::mutex mutex_;
  RunnerStatistics statistics_;
  std::exception_ptr failure_;
  std::atomic<bool> abandoned_{false};
  std::thread depth_thread_;
  std::thread site_thread_;
};

}  // namespace alight
