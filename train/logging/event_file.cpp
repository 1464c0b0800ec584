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
#include "train/event_file.pb.h"  // of event_file.proto
#include "train/logging/tfrecord.hpp"

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

/// The value with this tag, still empty, of an event that has no other.
tensorboard::Summary::Value& add_value(tensorboard::Event& event, std::int64_t step, const std::string& tag) {
  event.set_step(step);
  tensorboard::Summary::Value& value = *event.mutable_summary()->add_value();
  value.set_tag(tag);
  return value;
}

void fill(tensorboard::HistogramProto& histogram, const std::vector<double>& values) {
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
  histogram.set_min(min);
  histogram.set_max(max);
  histogram.set_num(static_cast<double>(values.size()));
  histogram.set_sum(sum);
  histogram.set_sum_squares(squares);
  *histogram.mutable_bucket_limit() = {limits.begin(), limits.end()};
  *histogram.mutable_bucket() = {counts.begin(), counts.end()};
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
  tensorboard::Event version;
  version.set_file_version("brain.Event:2");
  write(version);
  if (continue_after_step) {
    tensorboard::Event start;
    start.set_step(*continue_after_step + 1);
    start.mutable_session_log()->set_status(tensorboard::SessionLog::START);
    write(start);
  }
  flush();  // a full disk is known before the first epoch
}

void EventFile::scalar(const std::string& tag, std::int64_t step, double value) {
  tensorboard::Event event;
  add_value(event, step, tag).set_simple_value(static_cast<float>(value));
  write(event);
}

void EventFile::image(const std::string& tag, std::int64_t step, const cv::Mat& image) {
  if (image.empty() || (image.type() != CV_8UC3 && image.type() != CV_8UC1)) {
    throw std::invalid_argument("EventFile::image " + tag + ": expected a CV_8UC3 or CV_8UC1 image");
  }
  std::vector<unsigned char> png;
  cv::imencode(".png", image, png);
  tensorboard::Event event;
  tensorboard::Summary::Image& shown = *add_value(event, step, tag).mutable_image();
  shown.set_height(image.rows);
  shown.set_width(image.cols);
  shown.set_colorspace(image.channels());
  shown.set_encoded_image_string(png.data(), png.size());
  write(event);
}

void EventFile::histogram(const std::string& tag, std::int64_t step, const std::vector<float>& values) {
  std::vector<double> finite;
  std::copy_if(values.begin(), values.end(), std::back_inserter(finite),
               [](float v) { return std::isfinite(v); });
  tensorboard::Event event;
  fill(*add_value(event, step, tag).mutable_histo(), finite);
  write(event);
}

void EventFile::text(const std::string& tag, std::int64_t step, const std::string& markdown) {
  tensorboard::Event event;
  tensorboard::Summary::Value& value = add_value(event, step, tag);
  value.mutable_metadata()->mutable_plugin_data()->set_plugin_name("text");
  tensorboard::TensorProto& tensor = *value.mutable_tensor();
  tensor.set_dtype(tensorboard::DT_STRING);
  tensor.mutable_tensor_shape()->add_dim()->set_size(1);
  tensor.add_string_val(markdown);
  write(event);
}

void EventFile::flush() {
  stream_.flush();
  check_stream();
}

void EventFile::write(tensorboard::Event& event) {
  event.set_wall_time(clock_());
  stream_ << tfrecord(event.SerializeAsString());
  check_stream();
}

void EventFile::check_stream() const {
  if (!stream_) {
    throw DataError(path_.string() + ": cannot be written; check the folder, its rights and the free space");
  }
}

}  // namespace alight
