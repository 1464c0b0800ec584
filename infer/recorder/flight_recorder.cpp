#include "infer/recorder/flight_recorder.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <spdlog/spdlog.h>

#include "foundation/config_reader.hpp"
#include "geometry/depth_map.hpp"
#include "infer/replay/result_writer.hpp"

namespace alight {
namespace {

constexpr double kBytesOfAMegabyte = 1e6;

SegmentLogLimits limits_of(const RecorderConfig& config) {
  return {static_cast<std::int64_t>(config.segment_mb * kBytesOfAMegabyte),
          static_cast<std::int64_t>(config.total_mb * kBytesOfAMegabyte)};
}

std::string encoded(const cv::Mat& image, int width_px, int interpolation, const char* format,
                    const std::vector<int>& options = {}) {
  const double scale = std::min(1.0, static_cast<double>(width_px) / image.cols);
  cv::Mat small;
  cv::resize(image, small, {}, scale, scale, interpolation);
  std::vector<std::uint8_t> bytes;
  cv::imencode(format, small, bytes, options);
  return {bytes.begin(), bytes.end()};
}

}  // namespace

void bind(Binder& b, RecorderConfig& c) {
  b.field("segment_mb", c.segment_mb, "size of one file, megabytes", between(0.001, 10000));
  b.field("total_mb", c.total_mb, "of all files; the oldest is deleted first", between(0.002, 10'000'000));
  b.check("total_mb", c.total_mb >= 2 * c.segment_mb, "must hold two segments");
  b.field("image_every", c.image_every, "pictures every so many results; 0: at changes only", at_least(0));
  b.field("image_width_px", c.image_width_px, "of the pictures", between(16, 10000));
  b.field("jpeg_quality", c.jpeg_quality, "of the left image", between(1, 100));
  b.field("max_waiting", c.max_waiting, "results that may wait for the disk", between(1, 10000));
  b.field("sync_s", c.sync_s, "what is older survives the loss of power", between(0.01, 3600));
}

void bind(Binder& b, RecordedSettings& c) {
  b.field("crop_x_px", c.crop_x_px, "left edge of the results' images in the rectified image", at_least(0));
  b.field("crop_y_px", c.crop_y_px, "their upper edge", at_least(0));
  b.section("engine", c.engine, "how messages became depth");
  b.section("landing", c.landing, "how depth became a landing site");
}

FlightRecorder::FlightRecorder(const RecorderConfig& config, const std::filesystem::path& folder,
                               const RecordedSettings& settings)
    : config_(config),
      crop_(settings.crop_x_px, settings.crop_y_px, settings.engine.width_px, settings.engine.height_px),
      log_(folder, limits_of(config), {RecordKind::kSettings, 0, print_config(settings)}),
      thread_([this] { run(); }) {}

FlightRecorder::~FlightRecorder() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void FlightRecorder::on_message(const LogMessage& message) {
  latest_ns_ = std::visit([](const auto& typed) { return typed.t_ns; }, message);
}

void FlightRecorder::on_health(const HealthReport& health) { push(HealthChange{latest_ns_, health}); }

void FlightRecorder::push(Item item) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() >= static_cast<std::size_t>(config_.max_waiting)) {
      waiting_.pop_front();
      ++statistics_.lost;
    }
    waiting_.push_back(std::move(item));
  }
  changed_.notify_one();
}

RecorderStatistics FlightRecorder::statistics() const {
  const std::lock_guard lock(mutex_);
  return statistics_;
}

void FlightRecorder::run() {
  const auto period = std::chrono::duration<double>(config_.sync_s);
  auto synced = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait_for(lock, period, [this] { return closing_ || !waiting_.empty(); });
    if (waiting_.empty() && closing_) return;
    std::deque<Item> items;
    items.swap(waiting_);
    lock.unlock();
    for (const Item& item : items) std::visit([this](const auto& typed) { write(typed); }, item);
    if (const auto now = std::chrono::steady_clock::now(); now - synced >= period) {
      log_.sync();
      synced = now;
    }
    lock.lock();
  }
}

void FlightRecorder::append(RecordKind kind, std::int64_t t_ns, std::string content) {
  const bool written = log_.append({kind, t_ns, std::move(content)});
  if (!written && !disk_failed_) {
    spdlog::error("the flight is not recorded any more: {}; flying goes on", log_.error());
  }
  if (written && disk_failed_) spdlog::info("the flight is recorded again");
  disk_failed_ = !written;
  const std::lock_guard lock(mutex_);
  ++(written ? statistics_.records : statistics_.lost);
}

void FlightRecorder::write(const FrameReport& frame) {
  auto json = nlohmann::ordered_json::parse(to_json_line(frame, crop_, true));
  if (frame.selection && frame.selection->largest) {
    json["largest_radius_m"] = frame.selection->largest->radius_m;
  }
  append(RecordKind::kFrame, frame.depth.t_ns, json.dump());
  const bool due = config_.image_every > 0 && results_++ % config_.image_every == 0;
  if (state_changed(frame) || due) write_pictures(frame);
}

void FlightRecorder::write(const HealthChange& change) {
  append(RecordKind::kHealth, change.t_ns, health_json(change.health));
}

/// Depth's source, site or none, accepted or not, wandering, health.
bool FlightRecorder::state_changed(const FrameReport& frame) {
  const bool accepted = frame.decision.site && frame.decision.site->accepted;
  std::string state = std::string(name(frame.depth.source)) + (frame.decision.site ? " site" : "") +
                      (accepted ? " accepted" : "") + (frame.decision.wander ? " wander " : " ") +
                      name(frame.health.state) + describe(frame.health);
  return std::exchange(last_state_, state) != state;
}

void FlightRecorder::write_pictures(const FrameReport& frame) {
  const std::int64_t t_ns = frame.depth.t_ns;
  const int width_px = config_.image_width_px;
  if (!frame.depth.left.empty()) {
    append(RecordKind::kLeft, t_ns,
           encoded(frame.depth.left, width_px, cv::INTER_AREA, ".jpg",
                   {cv::IMWRITE_JPEG_QUALITY, config_.jpeg_quality}));
  }
  if (!frame.depth.depth_m.empty()) {
    append(RecordKind::kDepth, t_ns,
           encoded(encode_depth(frame.depth.depth_m), width_px, cv::INTER_NEAREST, ".png"));
  }
  if (frame.selection) {
    cv::Mat safe = cv::Mat::zeros(frame.selection->safe.size(), CV_8UC1);
    safe.setTo(128, frame.selection->terrain.known);
    safe.setTo(255, frame.selection->safe);
    append(RecordKind::kSafe, t_ns, encoded(safe, width_px, cv::INTER_NEAREST, ".png"));
  }
}

}  // namespace alight
