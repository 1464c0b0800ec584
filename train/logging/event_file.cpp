#include "train/logging/event_file.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

#include "foundation/errors.hpp"
#include "train/logging/tfrecord.hpp"
#include "train/logging/wire_message.hpp"

// Field numbers are those of event.proto, summary.proto, tensor.proto and tensor_shape.proto in TensorBoard's
// tensorboard/compat/proto.
namespace alight {
namespace fs = std::filesystem;
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0' ? name.data() : "localhost";
}

/// TensorBoard reads a folder's files in the order of their names, so a later file needs a later name, within the
/// same second too.
fs::path free_name(const fs::path& folder, double now_s) {
  char seconds[24];
  std::snprintf(seconds, sizeof seconds, "%010lld", static_cast<long long>(now_s));
  const std::string stem = std::string("events.out.tfevents.") + seconds + "." + host_name() + ".";
  for (int number = 0;; ++number) {
    char text[16];
    std::snprintf(text, sizeof text, "%03d", number);
    std::error_code ignored;
    if (!fs::exists(folder / (stem + text), ignored)) return folder / (stem + text);
  }
}

WireMessage histogram_message(std::vector<double> values) {
  constexpr std::size_t kBuckets = 30;
  double sum = 0;
  double squares = 0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const auto [first, last] = std::minmax_element(values.begin(), values.end());
  const double min = values.empty() ? 0 : *first;
  const double max = values.empty() ? 0 : *last;
  const double width = (max - min) / kBuckets;
  std::vector<double> limits(width > 0 ? kBuckets : 1, max);
  std::vector<double> counts(limits.size(), 0);
  for (std::size_t i = 0; i + 1 < limits.size(); ++i) limits[i] = min + width * static_cast<double>(i + 1);
  for (const double value : values) {
    const double bucket = width > 0 ? (value - min) / width : 0;
    ++counts[std::min(static_cast<std::size_t>(bucket), counts.size() - 1)];
  }
  WireMessage histogram;
  histogram.real(1, min)
      .real(2, max)
      .real(3, static_cast<double>(values.size()))
      .real(4, sum)
      .real(5, squares);
  return histogram.reals(6, limits).reals(7, counts);
}

}  // namespace

double wall_time_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

EventFile::EventFile(const fs::path& folder, std::optional<std::int64_t> continue_after_step, WallClock clock)
    : clock_(std::move(clock)) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) throw DataError(folder.string() + ": cannot be created: " + code.message());
  path_ = free_name(folder, clock_());
  stream_.open(path_, std::ios::binary);
  check_stream();
  write(WireMessage().text(3, "brain.Event:2"));
  if (continue_after_step) {
    constexpr int kStart = 1;  // SessionLog.START: what was read before with this step or a later one is void
    write(WireMessage().integer(2, *continue_after_step + 1).message(7, WireMessage().integer(1, kStart)));
  }
  flush();  // a full disk is known before the first epoch
}

void EventFile::scalar(const std::string& tag, std::int64_t step, double value) {
  write_summary(step, WireMessage().text(1, tag).real32(2, static_cast<float>(value)));
}

void EventFile::image(const std::string& tag, std::int64_t step, const cv::Mat& image) {
  if (image.empty() || (image.type() != CV_8UC3 && image.type() != CV_8UC1)) {
    throw std::invalid_argument("EventFile::image " + tag + ": expected a CV_8UC3 or CV_8UC1 image");
  }
  std::vector<unsigned char> png;
  cv::imencode(".png", image, png);
  WireMessage message;
  message.integer(1, image.rows).integer(2, image.cols).integer(3, image.channels());
  message.text(4, std::string(png.begin(), png.end()));
  write_summary(step, WireMessage().text(1, tag).message(4, message));
}

void EventFile::histogram(const std::string& tag, std::int64_t step, const std::vector<float>& values) {
  std::vector<double> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](float v) { return std::isfinite(v); });
  write_summary(step, WireMessage().text(1, tag).message(5, histogram_message(std::move(finite))));
}

void EventFile::text(const std::string& tag, std::int64_t step, const std::string& markdown) {
  constexpr int kString = 7;  // DataType.DT_STRING
  const WireMessage plugin = WireMessage().message(1, WireMessage().text(1, "text"));
  const WireMessage one_element = WireMessage().message(2, WireMessage().integer(1, 1));
  const WireMessage tensor = WireMessage().integer(1, kString).message(2, one_element).text(8, markdown);
  write_summary(step, WireMessage().text(1, tag).message(9, plugin).message(8, tensor));
}

void EventFile::flush() {
  stream_.flush();
  check_stream();
}

void EventFile::write_summary(std::int64_t step, const WireMessage& value) {
  write(WireMessage().integer(2, step).message(5, WireMessage().message(1, value)));
}

void EventFile::write(WireMessage event) {
  stream_ << tfrecord(event.real(1, clock_()).bytes());
  check_stream();
}

void EventFile::check_stream() const {
  if (!stream_) {
    throw DataError(path_.string() + ": cannot be written; check the folder, its rights and the free space");
  }
}

}  // namespace alight
