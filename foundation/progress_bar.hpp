#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace alight {

/// One line on stderr for long work: `label  [=====>    ]  42 %  8.1 frames/s  0:31 left  extra`.
/// Draws at most ten times a second on a terminal. Where stderr is no terminal it prints a plain line every
/// ten seconds, so that logs show life without being flooded. Silent where log lines of level info are (--quiet).
class ProgressBar {
 public:
  ProgressBar(std::string label, std::int64_t total, std::string unit);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void advance(std::int64_t count = 1, const std::string& extra = "");
  /// Draws the last state and ends the line; also called by the destructor.
  void finish();

 private:
  void draw();
  double elapsed_s() const;

  std::string label_;
  std::string unit_;
  std::string extra_;
  std::int64_t total_;
  std::int64_t done_ = 0;
  bool terminal_;
  bool finished_ = false;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
};

}  // namespace alight
