#include "infer/depth/depth_engine.hpp"

#include <algorithm>
#include <utility>

#include "foundation/config_reader.hpp"
#include "geometry/crop.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr char kLogEnded[] = "the log ended";
constexpr std::int64_t kMaxHeightAge_ns = 100'000'000;

cv::Rect fitting_crop(cv::Size image, cv::Size wanted) {
  if (wanted.width > image.width || wanted.height > image.height) {
    throw ConfigError("engine.width_px and height_px: a crop of " + std::to_string(wanted.width) + "x" +
                      std::to_string(wanted.height) + " does not fit into images of " +
                      std::to_string(image.width) + "x" + std::to_string(image.height) +
                      "; choose a smaller one");
  }
  return centre_crop(image, wanted);
}

}  // namespace

void bind(Binder& b, DepthEngineConfig& c) {
  b.field("width_px", c.width_px, "width of the centre crop", between(16, 10000));
  b.field("height_px", c.height_px, "height of the centre crop", between(16, 10000));
  b.field("history_s", c.history_s, "LiDAR of the past that an image may use; 0: only what follows it",
          between(0, 60));
  b.field("register_heights", c.register_heights,
          "LiDAR packets are shifted in height onto the ground of those before");
  b.field("max_pose_gap_s", c.max_pose_gap_s, "poses further apart are not interpolated between",
          between(0.001, 10));
  b.field("max_wait_s", c.max_wait_s, "how late a pose or LiDAR packet may come", between(0, 10));
  b.field("lidar_timeout_s", c.lidar_timeout_s, "without a packet for so long the LiDAR is silent",
          between(0.01, 60));
  b.choice("newer_image", c.newer_image, {{"finish", NewerImage::kFinish}, {"latest", NewerImage::kLatest}},
           "an image that waits for LiDAR when a newer one comes: is refined to the end, or ends as it is");
  b.field("max_open_images", c.max_open_images, "images in work at once", between(1, 1000));
  b.field("max_points", c.max_points, "LiDAR points held", at_least(1));
  b.section("image", c.image, "how one image is worked on");
  b.section("health", c.health, "when sensors are not believed");
}

DepthEngine::DepthEngine(const DepthEngineConfig& config, const Rig& rig,
                         std::shared_ptr<DepthPredictor> predictor)
    : config_(config),
      rectifier_(rig),
      crop_(fitting_crop(rectifier_.rig().intrinsics.size(), {config.width_px, config.height_px})),
      rig_(alight::crop(rectifier_.rig(), crop_)),
      predictor_(std::move(predictor)),
      aligner_({config.max_pose_gap_s, config.max_wait_s}, rig_.T_camera_imu.inverse() * rig_.T_camera_lidar),
      window_(static_cast<std::size_t>(config.max_points)) {
  if (!rig.lidar0)
    throw ConfigError("the rig has no lidar0: the engine needs a LiDAR; add it to the rig file");
  if (!rig.cam0.T_camera_imu)
    throw ConfigError(
        "the rig's cam0 has no T_cam_imu: without it attitudes say nothing about where the camera looks; add "
        "it to the rig file");
}

void DepthEngine::add(const LogMessage& message) {
  const bool first = !aligner_.now_ns();
  if (const auto* frame = std::get_if<StereoFrame>(&message)) {
    receive(*frame);
  } else if (const auto* packet = std::get_if<LidarPacket>(&message)) {
    receive(*packet);
  } else if (const auto* attitude = std::get_if<AttitudeSample>(&message)) {
    aligner_.add(*attitude);
  } else if (const auto* position = std::get_if<PositionSample>(&message)) {
    aligner_.add(*position);
  } else {
    aligner_.add(std::get<HeightSample>(message));
  }
  if (first) lidar_ns_ = *aligner_.now_ns();
  work();
}

void DepthEngine::forget_lidar(const std::string& reason) {
  aligner_.forget_packets();
  window_ = PacketWindow(static_cast<std::size_t>(config_.max_points));
  registration_.forget();
  for (Entry& entry : entries_) {
    if (!entry.task) continue;
    entry.task.reset();
    give_up(entry, reason);
  }
}

void DepthEngine::receive(const StereoFrame& frame) {
  aligner_.saw(frame.t_ns);
  Entry& entry = entries_.emplace_back();
  entry.t_ns = frame.t_ns;
  if (last_image_ns_ && frame.t_ns <= *last_image_ns_) {
    return give_up(entry, "not later than the image before it");
  }
  last_image_ns_ = frame.t_ns;
  entry.frame = frame;
}

void DepthEngine::receive(const LidarPacket& packet) {
  aligner_.add(packet);
  lidar_ns_ = std::max(lidar_ns_, end_of(packet));
}

bool DepthEngine::lidar_silent() const {
  return to_seconds(*aligner_.now_ns() - lidar_ns_) > config_.lidar_timeout_s;
}

int DepthEngine::open_count() const {
  return static_cast<int>(
      std::count_if(entries_.begin(), entries_.end(), [](const Entry& e) { return e.task != nullptr; }));
}

void DepthEngine::work() {
  while (auto packet = aligner_.next()) place(std::move(*packet));
  open_images();
  advance_tasks();
  forget();
}

void DepthEngine::place(WorldPacket packet) {
  if (packet.points.empty()) return;
  if (config_.register_heights) packet.height_shift_m = registration_.add(packet);
  const auto world = std::make_shared<const WorldPacket>(std::move(packet));
  window_.add(world);
  for (Entry& entry : entries_) {
    const bool wanted = config_.history_s > 0 || world->end_ns > entry.t_ns;
    if (entry.task && wanted) entry.task->offer(world);
  }
}

void DepthEngine::open_images() {
  for (Entry& entry : entries_) {
    if (!entry.frame) continue;
    if (const auto T_world_imu = aligner_.T_world_imu(entry.t_ns)) {
      open(entry, *T_world_imu * rig_.T_camera_imu.inverse());
    } else if (aligner_.finished()) {
      give_up(entry, std::string("no pose: ") + kLogEnded);
    } else if (aligner_.settled(entry.t_ns)) {
      give_up(entry, "no pose: attitude or position has a gap there");
    } else if (aligner_.late(entry.t_ns)) {
      give_up(entry, "no pose: attitude or position did not come in time");
    }
  }
}

void DepthEngine::open(Entry& entry, const Eigen::Isometry3d& T_world_camera) {
  if (config_.newer_image == NewerImage::kLatest) pre_empt_before(entry.t_ns);
  if (open_count() >= config_.max_open_images) return give_up(entry, "engine busy with earlier images");
  StageTimes stages_ms;
  PredictorView view;
  {
    const StageTimer timer(stages_ms, "rectify");
    view.left = entry.frame->left.empty() ? cv::Mat::zeros(crop_.size(), CV_8UC1)
                                          : rectifier_.rectify_left(entry.frame->left)(crop_).clone();
    if (!entry.frame->right.empty()) view.right = rectifier_.rectify_right(entry.frame->right)(crop_).clone();
  }
  DepthPredictor* predictor = entry.frame->left.empty() ? nullptr : predictor_.get();
  view.height_m = aligner_.heights().at_or_latest(entry.t_ns, kMaxHeightAge_ns);
  entry.frame.reset();
  int first_packets = 0;
  bool ask_network = true;
  begin_warm(first_packets, ask_network);
  entry.task =
      std::make_unique<ImageTask>(config_.image, rig_, ask_network ? predictor : nullptr, entry.t_ns,
                                  std::move(view), T_world_camera, std::move(stages_ms), first_packets);
  if (config_.history_s > 0) {
    for (const auto& packet : window_.before(entry.t_ns, config_.history_s, config_.history_s + 0.5)) {
      entry.task->offer(packet);
    }
  }
  for (const auto& packet : window_.after(entry.t_ns)) entry.task->offer(packet);
}

void DepthEngine::pre_empt_before(std::int64_t t_ns) {
  for (Entry& entry : entries_) {
    if (!entry.task || entry.t_ns >= t_ns) continue;
    entry.task->close(lidar_silent(), "a newer image came");
    conclude(entry);
  }
}

void DepthEngine::advance_tasks() {
  const bool silent = lidar_silent();
  for (Entry& entry : entries_) {
    if (!entry.task) continue;
    const double age_s = to_seconds(*aligner_.now_ns() - entry.t_ns);
    if (entry.task->advance(silent)) {
      conclude(entry);
    } else if (age_s > config_.image.max_accumulation_s + config_.max_wait_s) {
      entry.task->close(silent, "time is up");
      conclude(entry);
    } else if (silent) {
      entry.task->close(silent, "the LiDAR is silent");
      conclude(entry);
    }
  }
}

void DepthEngine::conclude(Entry& entry) {
  entry.result = entry.task->take();
  learn_from(*entry.task, entry.result->source);
  entry.task.reset();
}

void DepthEngine::begin_warm(int& first_packets, bool& ask_network) {
  const bool cold = warmth_.images >= config_.image.warm_images;
  warmth_.images = cold ? 0 : warmth_.images + 1;
  first_packets = cold && !warmth_.fell_back ? warmth_.packets / 2 : warmth_.packets;
  // Without LiDAR there is nothing to interpolate.
  ask_network = cold || !warmth_.fell_back || lidar_silent();
}

void DepthEngine::learn_from(const ImageTask& task, DepthSource source) {
  if (config_.image.warm_images == 0 || source == DepthSource::kNone || !task.asked_network()) return;
  const bool fell_back = source == DepthSource::kFallback;
  if (fell_back || task.packets_fed() > warmth_.packets) warmth_.images = 0;
  warmth_.packets = task.packets_fed();
  warmth_.fell_back = fell_back;
}

void DepthEngine::give_up(Entry& entry, const std::string& reason) {
  entry.frame.reset();
  entry.result.emplace();
  entry.result->t_ns = entry.t_ns;
  entry.result->reason = reason;
}

/// The oldest image that may still be opened is max_wait_s old; its LiDAR reaches back history_s and one packet.
void DepthEngine::forget() {
  const double keep_s = config_.history_s + config_.image.max_accumulation_s + config_.max_wait_s + 1.0;
  const std::int64_t before_ns = *aligner_.now_ns() - to_nanoseconds(keep_s);
  window_.forget_before(before_ns);
  aligner_.forget_before(before_ns);
}

void DepthEngine::finish() {
  if (!aligner_.now_ns()) return;
  aligner_.finish();
  while (auto packet = aligner_.next()) place(std::move(*packet));
  open_images();
  for (Entry& entry : entries_) {
    if (!entry.task) continue;
    entry.task->close(lidar_silent(), kLogEnded);
    conclude(entry);
  }
}

std::vector<DepthResult> DepthEngine::take_results() {
  std::vector<DepthResult> ready;
  while (!entries_.empty() && entries_.front().result) {
    ready.push_back(std::move(*entries_.front().result));
    entries_.pop_front();
  }
  return ready;
}

}  // namespace alight
