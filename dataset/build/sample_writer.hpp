#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace alight {

/// Threads that take jobs from a bounded queue, in order: compressing pictures takes longer than making them. A job's
/// exception comes back at the next `add` or at `finish`; jobs that still wait are then not run.
class SampleWriter {
 public:
  SampleWriter(int threads, std::size_t max_waiting);
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
  int busy_ = 0;
  bool stop_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace alight
