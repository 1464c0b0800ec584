#include "foundation/progress_bar.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <spdlog/spdlog.h>
#include <unistd.h>

namespace alight {

ProgressBar::ProgressBar(std::string label, std::int64_t total, std::string unit)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      total_(std::max<std::int64_t>(total, 1)),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      drawn_(start_) {}

ProgressBar::~ProgressBar() { finish(); }

double ProgressBar::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void ProgressBar::advance(std::int64_t count, const std::string& extra) {
  done_ += count;
  extra_ = extra;
  const auto period = terminal_ ? std::chrono::milliseconds(100) : std::chrono::seconds(10);
  if (std::chrono::steady_clock::now() - drawn_ >= period) draw();
}

void ProgressBar::draw() {
  drawn_ = std::chrono::steady_clock::now();
  if (!spdlog::should_log(spdlog::level::info)) return;
  const double share = std::min(1.0, static_cast<double>(done_) / static_cast<double>(total_));
  const double rate = static_cast<double>(done_) / std::max(elapsed_s(), 1e-3);
  const auto left_s = rate > 0 ? static_cast<std::int64_t>(static_cast<double>(total_ - done_) / rate) : 0;
  constexpr int kWidth = 24;
  const int filled = static_cast<int>(share * kWidth);
  std::string bar(static_cast<std::size_t>(filled), '=');
  bar.resize(kWidth, ' ');
  std::fprintf(stderr, "%s%s  [%s] %3d %%  %.1f %s/s  %ld:%02ld left  %s%s", terminal_ ? "\r" : "",
               label_.c_str(), bar.c_str(), static_cast<int>(share * 100), rate, unit_.c_str(),
               static_cast<long>(left_s / 60), static_cast<long>(left_s % 60), extra_.c_str(),
               terminal_ ? "\033[K" : "\n");
  std::fflush(stderr);
}

void ProgressBar::finish() {
  if (finished_) return;
  finished_ = true;
  draw();
  if (terminal_ && spdlog::should_log(spdlog::level::info)) std::fputc('\n', stderr);
}

}  // namespace alight
