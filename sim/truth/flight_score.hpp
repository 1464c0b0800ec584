#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include <opencv2/core.hpp>

#include "foundation/errors.hpp"

namespace alight::sim {

/// Landing sites of a flight, held against its truth.
struct SiteCounts {
  std::int64_t frames = 0;         ///< lines of the results
  std::int64_t sites = 0;          ///< frames that name a site, accepted or not
  std::int64_t accepted = 0;       ///< frames that name an accepted site
  std::int64_t safe = 0;           ///< accepted sites that lie on truly safe ground
  std::int64_t unsafe_centre = 0;  ///< accepted sites whose centre is not safe
  std::int64_t unsafe_circle = 0;  ///< accepted sites whose centre is safe but too much of the circle is not
};

/// A flight's landing sites, counted against the truth.
struct FlightScore {
  SiteCounts all;
  std::map<std::string, SiteCounts> by_source;  ///< image, lidar, fallback, none
};

/// How much of a circle has to be safe ground.
constexpr double kSafeCircleShare = 0.97;

/// Share of a circle's pixels that are safe; what lies outside the image is not. A circle has at least its
/// centre.
double safe_share(const cv::Mat& safe, double u_px, double v_px, double radius_px);

/// Counts the landing sites of alight-infer's results.jsonl that lie on safe ground: the centre's pixel is
/// safe and so are kSafeCircleShare of the circle's pixels. Sites are pixels of the cropped left image;
/// `crop` in each line says where the crop lies. `t_ns` is on the IMU's clock; the truth's rig.yaml leads
/// back to the image's stamp.
/// @param truth folder `<flight>.truth`. @throws DataError naming file and line
FlightScore score_flight(const std::filesystem::path& truth, const std::filesystem::path& results);

/// A table for people, one row a source.
std::string format_score(const FlightScore& score);

}  // namespace alight::sim
