#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace alight {

/// A thread that runs jobs in order, with a bounded queue: compressing pictures takes longer than making
/// them. A job's exception comes back at the next `add` or at `finish`; later jobs are then not run.
class SampleWriter {
 public:
  explicit SampleWriter(std::size_t max_waiting);
  /// Drops waiting jobs.
  ~SampleWriter();
  SampleWriter(const SampleWriter&) = delete;
  SampleWriter& operator=(const SampleWriter&) = delete;

  /// Blocks while the queue is full.
  void add(std::function<void()> job);
  /// Waits for all jobs.
  void finish();

 private:
  void run();

  const std::size_t max_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> jobs_;
  std::exception_ptr error_;
  bool busy_ = false;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace alight
