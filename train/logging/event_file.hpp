#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "foundation/errors.hpp"

namespace alight {

namespace tensorboard {
class Event;  // NOLINT(bugprone-forward-declaration-namespace): OpenCV's Event is another
}

/// Seconds since 1970. Tests hand in a clock of their own.
using WallClock = std::function<double()>;
double wall_time_s();

/// A TensorBoard event file, `events.out.tfevents.<unix seconds>.<host>.<number>`, the number counting up where the
/// name is taken. `tensorboard --logdir <folder>` shows it while it grows. Values with the same tag make one chart; a
/// slash in a tag groups charts. Every writing member throws DataError naming the file where the disk does not take
/// the bytes; as they are buffered, the last ones are known to be there only after flush().
class EventFile {
 public:
  /// Makes the folder where it is missing. @param continue_after_step for a run that goes on from a checkpoint:
  /// TensorBoard then forgets what earlier files in the folder say about later steps. @throws DataError
  explicit EventFile(const std::filesystem::path& folder,
                     std::optional<std::int64_t> continue_after_step = {}, WallClock clock = wall_time_s);

  void scalar(const std::string& tag, std::int64_t step, double value);
  /// @param image CV_8UC3 BGR or CV_8UC1. @throws std::invalid_argument if it is empty or of another type
  void image(const std::string& tag, std::int64_t step, const cv::Mat& image);
  /// Thirty buckets between the smallest and the largest value. Values that are not finite are left out.
  void histogram(const std::string& tag, std::int64_t step, const std::vector<float>& values);
  void text(const std::string& tag, std::int64_t step, const std::string& markdown);
  /// Hands everything to the operating system.
  void flush();

  const std::filesystem::path& path() const { return path_; }

 private:
  /// Gives the event its time.
  void write(tensorboard::Event& event);
  void check_stream() const;

  WallClock clock_;
  std::filesystem::path path_;
  std::ofstream stream_;
};

}  // namespace alight
