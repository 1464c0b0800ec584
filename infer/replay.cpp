#include "infer/replay.hpp"

#include <optional>
#include <utility>

#include <opencv2/imgcodecs.hpp>

#include "cli/output_folder.hpp"
#include "cli/progress_bar.hpp"
#include "infer/overlay.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

void write_picture(const fs::path& path, const cv::Mat& picture) {
  bool written = false;
  try {
    written = cv::imwrite(path.string(), picture);
  } catch (const cv::Exception&) {
    written = false;
  }
  if (!written) throw DataError(path.string() + ": cannot be written; check the folder and the free space");
}

/// The files of a replay; they appear when it ends well.
class ReplayOutput {
 public:
  ReplayOutput(const fs::path& path, const ReplayConfig& config, const cv::Rect& crop)
      : folder_(path),
        every_(config.overlay_every),
        results_(folder_.partial() / "results.jsonl", crop, config.write_timings) {
    if (every_ > 0) fs::create_directories(folder_.partial() / "overlay");
    write_file_atomically(folder_.partial() / "config.yaml", print_config(config));
  }

  void add(const FrameReport& frame) {
    results_.write(frame);
    const bool due = every_ > 0 && images_++ % every_ == 0;
    if (frame.depth.left.empty()) return;
    if (due) {
      write_picture(folder_.partial() / "overlay" / (std::to_string(frame.depth.t_ns) + ".png"),
                    replay_strip(frame));
    }
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
  ResultWriter results_;
  std::int64_t images_ = 0;
  int method_rank_ = 0;
};

}  // namespace

void bind(Binder& b, ReplayConfig& c) {
  b.field("rig", c.rig, "sensors and their mounting");
  b.field("checkpoint", c.checkpoint, "the trained network; none: the one that came with the program");
  b.field("overlay_every", c.overlay_every, "a picture every so many images; 0: none", at_least(0));
  b.field("write_timings", c.write_timings, "stages_ms in results.jsonl, which differs from run to run");
  b.section("log", c.log, "how the log is read");
  b.section("network", c.network, "where and how the network runs");
  b.section("engine", c.engine, "how messages become depth");
  b.section("landing", c.landing, "how depth becomes a landing site");
}

ReplaySummary replay(const ReplayConfig& config, const Rig& rig, const fs::path& log, const fs::path& output,
                     std::shared_ptr<DepthPredictor> predictor) {
  LandingPipeline pipeline(config.engine, config.landing, rig, std::move(predictor));
  std::optional<ReplayOutput> files;
  if (!output.empty()) files.emplace(output, config, pipeline.engine().crop());
  FlightLog flight(log, rig, config.log);
  ReplaySummary summary;
  const auto take = [&](const std::vector<FrameReport>& frames) {
    for (const FrameReport& frame : frames) {
      summary.add(frame);
      if (files) files->add(frame);
    }
  };
  ProgressBar bar(log.filename().string(), flight.summary().messages, "messages");
  LogMessage message;
  std::int64_t consumed = 0;
  while (flight.next(message)) {
    take(pipeline.add(message));
    bar.advance(flight.consumed() - consumed, std::to_string(summary.images) + " images");
    consumed = flight.consumed();
  }
  take(pipeline.finish());
  bar.finish();
  summary.left_out = flight.summary().dropped;
  for (const auto& [reason, count] : pipeline.engine().dropped()) summary.left_out[reason] += count;
  if (files) files->commit();
  return summary;
}

RectifiedRig engine_rig(const DepthEngineConfig& config, const Rig& rig) {
  return DepthEngine(config, rig, nullptr).rig();
}

}  // namespace alight
