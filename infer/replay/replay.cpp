#include "infer/replay/replay.hpp"

#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "foundation/config_reader.hpp"
#include "foundation/output_folder.hpp"
#include "foundation/progress_bar.hpp"
#include "infer/replay/looped_log.hpp"
#include "infer/replay/overlay.hpp"
#include "pictures/picture_file.hpp"

namespace alight {
namespace fs = std::filesystem;

class ReplayResults::Files {
 public:
  Files(const fs::path& path, const ReplayConfig& config, const cv::Rect& crop)
      : folder_(path),
        every_(config.overlay_every),
        depth_every_(config.depth_every),
        results_(folder_.partial() / "results.jsonl", crop, config.write_timings) {
    if (every_ > 0) fs::create_directories(folder_.partial() / "overlay");
    if (depth_every_ > 0) fs::create_directories(folder_.partial() / "depth");
    write_file_atomically(folder_.partial() / "config.yaml", print_config(config));
  }

  void add(const FrameReport& frame) {
    results_.write(frame);
    const bool due = every_ > 0 && images_ % every_ == 0;
    const bool depth_due = depth_every_ > 0 && images_ % depth_every_ == 0;
    ++images_;
    const std::string name = std::to_string(frame.depth.t_ns);
    if (depth_due && !frame.depth.depth_m.empty()) {
      write_picture(folder_.partial() / "depth" / (name + ".tiff"), frame.depth.depth_m);
    }
    if (frame.depth.left.empty()) return;
    if (due) write_picture(folder_.partial() / "overlay" / (name + ".png"), replay_strip(frame));
    draw_method(frame);
  }
  void commit() { folder_.commit(); }

 private:
  void draw_method(const FrameReport& frame) {
    if (every_ <= 0 || !frame.decision.site || !frame.decision.site->accepted) return;
    const int rank = frame.depth.source == DepthSource::kLidar   ? 3
                     : frame.depth.source == DepthSource::kImage ? 2
                                                                 : 1;
    if (rank <= method_rank_) return;
    method_rank_ = rank;
    write_picture(folder_.partial() / "method.png", method_strip(frame));
  }

  OutputFolder folder_;
  int every_;
  int depth_every_;
  ResultWriter results_;
  std::int64_t images_ = 0;
  int method_rank_ = 0;
};

void bind(Binder& b, ReplayConfig& c) {
  b.field("rig", c.rig, "sensors and their mounting");
  b.field("checkpoint", c.checkpoint, "the trained network; none: the one that came with the program");
  b.field("overlay_every", c.overlay_every, "a picture every so many images; 0: none", at_least(0));
  b.field("depth_every", c.depth_every, "a depth map (TIFF) every so many images; 0: none", at_least(0));
  b.field("write_timings", c.write_timings, "stages_ms in results.jsonl, which differs from run to run");
  b.section("log", c.log, "how the log is read");
  b.section("queue", c.queue, "what may wait for the engine, in real time");
  b.section("network", c.network, "where and how the network runs");
  b.section("engine", c.engine, "how messages become depth");
  b.section("landing", c.landing, "how depth becomes a landing site");
  b.section("autopilot", c.autopilot, "how landing sites are sent to the autopilot, in real time");
}

ReplayResults::ReplayResults(const ReplayConfig& config, const fs::path& output, const cv::Rect& crop) {
  if (!output.empty()) files_ = std::make_unique<Files>(output, config, crop);
}

ReplayResults::~ReplayResults() = default;

void ReplayResults::on_frame(const FrameReport& frame) {
  summary_.add(frame);
  if (files_) files_->add(frame);
}

void ReplayResults::commit() {
  if (files_) files_->commit();
}

namespace {

/// Whoever observes a runner hears of its end, however that comes.
class Observation {
 public:
  Observation(const std::function<void(const EngineRunner*)>& observe, const EngineRunner& runner)
      : observe_(observe) {
    if (observe_) observe_(&runner);
  }
  ~Observation() {
    if (observe_) observe_(nullptr);
  }
  Observation(const Observation&) = delete;
  Observation& operator=(const Observation&) = delete;

 private:
  const std::function<void(const EngineRunner*)>& observe_;
};

void replay_at_once(LoopedLog& log, LandingPipeline& pipeline, const std::vector<FrameSink*>& sinks,
                    ProgressBar& bar) {
  std::int64_t images = 0;
  const auto deliver = [&](const std::vector<FrameReport>& frames) {
    images += static_cast<std::int64_t>(frames.size());
    for (const FrameReport& frame : frames) {
      for (FrameSink* sink : sinks) sink->on_frame(frame);
    }
  };
  LogMessage message;
  for (std::int64_t consumed = 0; log.next(message); consumed = log.consumed()) {
    for (FrameSink* sink : sinks) sink->on_message(message);
    deliver(pipeline.add(message));
    bar.advance(log.consumed() - consumed, std::to_string(images) + " images");
  }
  deliver(pipeline.finish());
}

void replay_in_real_time(LoopedLog& log, EngineRunner& runner, ProgressBar& bar) {
  std::optional<std::int64_t> begin_ns;
  const SteadyTime begin = steady_now();
  LogMessage message;
  for (std::int64_t consumed = 0; log.next(message) && !runner.failed(); consumed = log.consumed()) {
    if (!begin_ns) begin_ns = log.receive_ns();
    std::this_thread::sleep_until(begin + std::chrono::nanoseconds(log.receive_ns() - *begin_ns));
    runner.push(std::move(message));
    bar.advance(log.consumed() - consumed, std::to_string(runner.statistics().images) + " images");
  }
  runner.finish();
}

}  // namespace

ReplaySummary replay(const ReplayConfig& config, const Rig& rig, const fs::path& log, const fs::path& output,
                     std::shared_ptr<DepthPredictor> predictor, const ReplayPace& pace,
                     const std::vector<FrameSink*>& sinks,
                     const std::function<void(const EngineRunner*)>& observe) {
  auto pipeline = std::make_unique<LandingPipeline>(config.engine, config.landing, rig, std::move(predictor));
  ReplayResults results(config, output, pipeline->engine().crop());
  std::vector<FrameSink*> all{&results};
  all.insert(all.end(), sinks.begin(), sinks.end());
  LoopedLog flight(log, rig, config.log, pace.rounds);
  ProgressBar bar(log.filename().string(), flight.messages(), "messages");
  ReplaySummary& summary = results.summary();
  if (pace.realtime) {
    EngineRunner runner(config.queue, std::move(pipeline), all);
    const Observation observation(observe, runner);
    const SteadyTime begin = steady_now();
    replay_in_real_time(flight, runner, bar);
    summary.live = runner.statistics();
    summary.live_s = milliseconds(begin, steady_now()) * 1e-3;
    summary.left_out = summary.live->dropped;
  } else {
    replay_at_once(flight, *pipeline, all, bar);
    summary.left_out = pipeline->engine().dropped();
  }
  bar.finish();
  for (const auto& [reason, count] : flight.dropped()) summary.left_out[reason] += count;
  results.commit();
  return summary;
}

RectifiedRig engine_rig(const DepthEngineConfig& config, const Rig& rig) {
  return DepthEngine(config, rig, nullptr).rig();
}

}  // namespace alight
