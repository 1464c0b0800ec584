#include "infer/recorder/explanation.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "foundation/output_folder.hpp"
#include "geometry/depth_map.hpp"
#include "geometry/frames.hpp"
#include "infer/recorder/flight_recorder.hpp"
#include "infer/recorder/segment_log.hpp"
#include "infer/replay/overlay.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kLeastStamp_ns = 1'000'000'000;

/// "0.412", "-" for null.
std::string figure(const Json& value, int digits = 3) {
  return value.is_number() ? fmt::format("{:.{}f}", value.get<double>(), digits) : "-";
}

/// All that is known of a result.
struct RecordedResult {
  RecordedSettings settings;
  Json frame;
  std::int64_t t_ns = 0;
  Json pictured;                 // the result of the pictures: its site belongs into them
  const Record* left = nullptr;  // the latest pictures until then
  const Record* depth = nullptr;
  const Record* safe = nullptr;
  const Record* health = nullptr;  // the latest change until the moment asked for
};

RecordedResult find_result(const std::vector<Record>& records, const fs::path& folder, std::int64_t t_ns) {
  const Record* frame = nullptr;
  const Record* settings = nullptr;
  RecordedResult result;
  for (const Record& record : records) {
    if (record.kind == RecordKind::kSettings) settings = &record;
    if (record.kind == RecordKind::kSettings || record.t_ns > t_ns) continue;
    if (record.kind == RecordKind::kFrame) frame = &record;
    if (record.kind == RecordKind::kHealth) result.health = &record;
  }
  if (frame == nullptr) throw DataError(folder.string() + ": holds no result until that moment");
  if (settings != nullptr)
    result.settings = parse_config<RecordedSettings>(settings->content, folder.string());
  result.frame = Json::parse(frame->content);
  result.t_ns = frame->t_ns;
  std::int64_t pictures_ns = 0;
  result.pictured = result.frame;
  for (const Record& record : records) {
    if (record.kind == RecordKind::kLeft && record.t_ns <= frame->t_ns)
      pictures_ns = std::max(pictures_ns, record.t_ns);
  }
  for (const Record& record : records) {
    if (record.kind == RecordKind::kSettings || record.t_ns != pictures_ns) continue;
    if (record.kind == RecordKind::kFrame) result.pictured = Json::parse(record.content);
    if (record.kind == RecordKind::kLeft) result.left = &record;
    if (record.kind == RecordKind::kDepth) result.depth = &record;
    if (record.kind == RecordKind::kSafe) result.safe = &record;
  }
  return result;
}

std::string health_text(const Json& health) {
  std::string text = "sensors: " + health.at("state").get<std::string>() + "\n";
  for (const Json& finding : health.at("findings")) {
    text += "  " + finding.at("sensor").get<std::string>() + " " + finding.at("fault").get<std::string>() +
            ": " + finding.at("reason").get<std::string>() + "\n";
  }
  return text;
}

std::string stereo_text(const Json& frame, const StereoTestConfig& limits) {
  std::string text = "stereo test: " + frame.at("stereo_verdict").get<std::string>() + "\n";
  if (!frame.at("sim_pred").is_number()) return text;
  const double sim = frame.at("sim").get<double>();
  text += "  similarity to the right image: as it is " + figure(frame.at("sim")) + ", by the LiDAR " +
          figure(frame.at("sim_d")) + ", by the prediction " + figure(frame.at("sim_pred")) + "\n";
  text += fmt::format("  limits: more than {:.3f} ({:.2f} over as it is)", sim + limits.min_gain,
                      limits.min_gain);
  if (frame.at("sim_d").is_number())
    text +=
        fmt::format(", or than {:.3f} (half way to the LiDAR)", (sim + frame.at("sim_d").get<double>()) / 2);
  text += "\n  peak over depth moved by " + fmt::format("{:.0f} %: ", 100 * limits.probe) +
          figure(frame.at("sim_peak")) + fmt::format(", limit {:.3f}\n", limits.min_peak);
  return text;
}

std::string holdout_text(const Json& frame, const HoldoutTestConfig& limits) {
  return "LiDAR hold-out test: " + frame.at("holdout_verdict").get<std::string>() + "\n" +
         fmt::format("  {} points (at least {}), median error ", frame.at("holdout_points").get<int>(),
                     limits.min_points) +
         figure(frame.at("holdout_median_relative"), 4) +
         fmt::format(" of the depth (at most {:.4f}), RMS ", limits.max_median_relative) +
         figure(frame.at("holdout_rms_relative"), 4) +
         fmt::format(" (at most {:.4f})\n", limits.max_rms_relative);
}

std::string site_text(const Json& frame, const LandingConfig& limits) {
  std::string text = "ground: ";
  if (frame.contains("largest_radius_m")) {
    text += fmt::format("largest safe circle {:.2f} m, more than {:.2f} m wanted\n",
                        frame.at("largest_radius_m").get<double>(), limits.selection.rules.min_radius_m);
  } else {
    text += "no safe circle was looked for, or none is there\n";
  }
  const Json& site = frame.at("site");
  if (!site.is_null()) {
    text += fmt::format("tracker: found in {} frames in a row, {} wanted\n", site.at("frames").get<int>(),
                        limits.tracker.confirm_frames);
  }
  if (frame.at("wander").get<bool>())
    text += fmt::format("no site has counted for {:.1f} s: wander\n", limits.tracker.wander_after_s);
  return text;
}

std::string conclusion(const Json& frame) {
  const Json& site = frame.at("site");
  const std::string reason = frame.at("site_reason").get<std::string>();
  if (site.is_null()) return "no landing site: " + reason;
  const char* standing =
      site.at("accepted").get<bool>() ? "landing site accepted: " : "landing site not yet confirmed: ";
  return standing + reason +
         fmt::format(", at ({:.2f}, {:.2f}, {:.2f}) m in the world", site.at("p_world")[0].get<double>(),
                     site.at("p_world")[1].get<double>(), site.at("p_world")[2].get<double>());
}

cv::Mat decoded(const Record* record, cv::Size size) {
  if (record == nullptr) return {};
  const std::vector<std::uint8_t> bytes(record->content.begin(), record->content.end());
  cv::Mat image = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  if (!image.empty()) cv::resize(image, image, size, 0, 0, cv::INTER_NEAREST);
  return image;
}

/// The pictured frame as far as it was recorded, for the panels of a replay.
FrameReport restored(const RecordedResult& result) {
  const Json& json = result.pictured;
  const cv::Size size(json.at("crop").at("width").get<int>(), json.at("crop").at("height").get<int>());
  FrameReport frame;
  frame.depth.t_ns = result.t_ns;
  frame.depth.accumulation_s = json.at("accumulation_s").get<double>();
  for (const DepthSource source : {DepthSource::kImage, DepthSource::kLidar, DepthSource::kFallback}) {
    if (json.at("source") == name(source)) frame.depth.source = source;
  }
  frame.depth.left = decoded(result.left, size);
  if (frame.depth.left.empty()) frame.depth.left = cv::Mat::zeros(size, CV_8UC3);
  if (result.depth != nullptr) {
    frame.depth.depth_m = decode_depth(decoded(result.depth, size));
    const PixelSource known =
        frame.depth.source == DepthSource::kFallback ? PixelSource::kInterpolated : PixelSource::kPredicted;
    frame.depth.pixel_source = cv::Mat::zeros(size, CV_8UC1);
    frame.depth.pixel_source.setTo(static_cast<int>(known), frame.depth.depth_m > 0);
  }
  if (const cv::Mat safe = decoded(result.safe, size); !safe.empty()) {
    frame.selection.emplace();
    frame.selection->safe = safe == 255;
    frame.selection->terrain.known = safe > 0;
  }
  if (const Json& site = json.at("site"); !site.is_null()) {
    TrackedSite tracked;
    tracked.frames = site.at("frames").get<int>();
    tracked.accepted = site.at("accepted").get<bool>();
    tracked.circle.radius_m = site.at("radius_m").get<double>();
    frame.decision.site = tracked;
    frame.image_site = ImageSite{site.at("u_px").get<double>(), site.at("v_px").get<double>(),
                                 site.at("radius_px").get<double>()};
  }
  return frame;
}

std::string picture_text(const RecordedResult& result) {
  if (result.left == nullptr) return "picture: none was recorded until then\n";
  return fmt::format("picture: of {:.2f} s before the result\n", to_seconds(result.t_ns - result.left->t_ns));
}

}  // namespace

Explanation explain(const fs::path& record, std::int64_t t_ns) {
  const SegmentLogContents contents = read_segments(record);
  const RecordedResult result = find_result(contents.records, record, t_ns);
  const Json& frame = result.frame;
  const SelfEvaluationConfig& tests = result.settings.engine.image.self_evaluation;
  Explanation explanation;
  explanation.t_ns = result.t_ns;
  explanation.picture = replay_strip(restored(result));
  std::string& text = explanation.text;
  text = fmt::format("result of {} ns, {:.3f} s before the moment asked for\n", result.t_ns,
                     to_seconds(t_ns - result.t_ns));
  text += conclusion(frame) + "\n" + health_text(frame.at("health"));
  if (result.health != nullptr && result.health->t_ns > result.t_ns) {
    text += "since then, " + health_text(Json::parse(result.health->content));
  }
  text += "depth: " + frame.at("source").get<std::string>() + ", " + frame.at("reason").get<std::string>() +
          fmt::format("; {:.2f} s of LiDAR, {} predictions\n", frame.at("accumulation_s").get<double>(),
                      frame.at("predictions").get<int>());
  text += stereo_text(frame, tests.stereo) + holdout_text(frame, tests.holdout);
  text += site_text(frame, result.settings.landing) + picture_text(result);
  for (const std::string& damage : contents.damages) text += "damage: " + damage + "\n";
  return explanation;
}

std::int64_t moment_of(const fs::path& record, const std::string& moment) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(moment, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != moment.size() || value < 0) {
    throw ConfigError("--explain " + moment +
                      ": is no time; say seconds from the record's begin, or nanoseconds");
  }
  if (value >= static_cast<double>(kLeastStamp_ns)) return std::stoll(moment);
  for (const Record& first : read_segments(record).records) {
    if (first.kind == RecordKind::kFrame) return first.t_ns + to_nanoseconds(value);
  }
  throw DataError(record.string() + ": holds no result");
}

int run_explain(const fs::path& record, const std::string& moment, const fs::path& picture) {
  const Explanation explanation = explain(record, moment_of(record, moment));
  std::vector<std::uint8_t> png;
  cv::imencode(".png", explanation.picture, png);
  write_file_atomically(picture, std::string(png.begin(), png.end()));
  std::printf("%spicture: %s\n", explanation.text.c_str(), picture.c_str());
  return 0;
}

}  // namespace alight
