#include "sim/truth/flight_score.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "foundation/errors.hpp"
#include "geometry/frames.hpp"
#include "geometry/rig/rig.hpp"

namespace alight::sim {
namespace fs = std::filesystem;
namespace {

struct Site {
  double u_px = 0;  // in the whole left image
  double v_px = 0;
  double radius_px = 0;
  bool accepted = false;
};

struct ResultLine {
  std::int64_t t_ns = 0;
  std::string source;
  std::optional<Site> site;
};

ResultLine parse_line(const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text);
  ResultLine line;
  line.t_ns = json.at("t_ns").get<std::int64_t>();
  line.source = json.at("source").get<std::string>();
  if (json.at("site").is_null()) return line;
  const nlohmann::json& site = json.at("site");
  const nlohmann::json& crop = json.at("crop");
  line.site = Site{site.at("u_px").get<double>() + crop.at("x").get<double>(),
                   site.at("v_px").get<double>() + crop.at("y").get<double>(),
                   site.at("radius_px").get<double>(), site.at("accepted").get<bool>()};
  return line;
}

cv::Mat read_safe(const fs::path& truth, std::int64_t stamp_ns, const std::string& where) {
  const fs::path path = truth / "safe" / (std::to_string(stamp_ns) + ".png");
  const cv::Mat safe = fs::exists(path) ? cv::imread(path.string(), cv::IMREAD_GRAYSCALE) : cv::Mat();
  if (safe.empty()) {
    throw DataError(where + ": its image is not in the truth (" + path.string() +
                    "); results and truth have to be of " + "the same flight");
  }
  return safe;
}

void count(const ResultLine& line, double share, bool centre_safe, SiteCounts& counts) {
  ++counts.frames;
  if (!line.site) return;
  ++counts.sites;
  if (!line.site->accepted) return;
  ++counts.accepted;
  if (!centre_safe) {
    ++counts.unsafe_centre;
  } else if (share < kSafeCircleShare) {
    ++counts.unsafe_circle;
  } else {
    ++counts.safe;
  }
}

std::string row(const std::string& name, const SiteCounts& counts) {
  const double percent = counts.accepted > 0
                             ? 100.0 * static_cast<double>(counts.safe) / static_cast<double>(counts.accepted)
                             : 0;
  return fmt::format("{:10} {:7} {:7} {:9} {:9} {:>8.1f} {:14} {:14}\n", name, counts.frames, counts.sites,
                     counts.accepted, counts.safe, percent, counts.unsafe_centre, counts.unsafe_circle);
}

}  // namespace

double safe_share(const cv::Mat& safe, double u_px, double v_px, double radius_px) {
  const int centre_u = static_cast<int>(std::lround(u_px));
  const int centre_v = static_cast<int>(std::lround(v_px));
  const int reach = static_cast<int>(std::ceil(std::max(radius_px, 0.0)));
  std::int64_t inside = 0;
  std::int64_t good = 0;
  for (int v = centre_v - reach; v <= centre_v + reach; ++v) {
    for (int u = centre_u - reach; u <= centre_u + reach; ++u) {
      const bool centre = u == centre_u && v == centre_v;
      if (!centre && std::hypot(u - u_px, v - v_px) > radius_px) continue;
      ++inside;
      if (u < 0 || v < 0 || u >= safe.cols || v >= safe.rows) continue;
      good += safe.at<std::uint8_t>(v, u) != 0 ? 1 : 0;
    }
  }
  return static_cast<double>(good) / static_cast<double>(inside);
}

FlightScore score_flight(const fs::path& truth, const fs::path& results) {
  if (!fs::is_directory(truth / "safe")) {
    throw DataError(truth.string() +
                    ": holds no folder safe/; name the <flight>.truth folder that alight-sim wrote");
  }
  const std::int64_t shift_ns = to_nanoseconds(load_rig(truth / "rig.yaml").cam0.timeshift_cam_imu_s);
  std::ifstream stream(results);
  if (!stream) throw DataError(results.string() + ": cannot be opened; check the path");
  FlightScore score;
  std::int64_t number = 0;
  for (std::string text; std::getline(stream, text);) {
    const std::string where = results.string() + ":" + std::to_string(++number);
    if (text.empty()) continue;
    ResultLine line;
    try {
      line = parse_line(text);
    } catch (const nlohmann::json::exception& e) {
      throw DataError(where + ": is no line of alight-infer's results: " + e.what());
    }
    double share = 0;
    bool centre_safe = false;
    if (line.site && line.site->accepted) {
      const cv::Mat safe = read_safe(truth, line.t_ns - shift_ns, where);
      share = safe_share(safe, line.site->u_px, line.site->v_px, line.site->radius_px);
      centre_safe = safe_share(safe, line.site->u_px, line.site->v_px, 0) > 0;
    }
    count(line, share, centre_safe, score.all);
    count(line, share, centre_safe, score.by_source[line.source]);
  }
  if (number == 0) throw DataError(results.string() + ": is empty; alight-infer writes one line an image");
  return score;
}

std::string format_score(const FlightScore& score) {
  std::string text = fmt::format("{:10} {:>7} {:>7} {:>9} {:>9} {:>8} {:>14} {:>14}\n", "source", "frames",
                                 "sites", "accepted", "safe", "safe %", "unsafe centre", "unsafe circle");
  for (const auto& [source, counts] : score.by_source) text += row(source, counts);
  return text + row("all", score.all);
}

}  // namespace alight::sim
