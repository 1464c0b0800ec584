#include "infer/health/camera_watch.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace alight {
namespace {

constexpr int kStep_px = 8;

/// Every eighth pixel each way as it is: averages would hide the noise that tells a picture from its copy.
std::vector<std::uint8_t> sampled(const cv::Mat& image) {
  const int channels = image.channels();
  const int green = channels == 3 ? 1 : 0;
  std::vector<std::uint8_t> sample;
  sample.reserve(image.total() / (kStep_px * kStep_px) + 1);
  for (int v = kStep_px / 2; v < image.rows; v += kStep_px) {
    const std::uint8_t* row = image.ptr<std::uint8_t>(v);
    for (int u = kStep_px / 2; u < image.cols; u += kStep_px) sample.push_back(row[u * channels + green]);
  }
  return sample;
}

double mean(const std::vector<std::uint8_t>& sample) {
  return std::accumulate(sample.begin(), sample.end(), 0.0) /
         static_cast<double>(std::max<std::size_t>(1, sample.size()));
}

double mean_difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(static_cast<int>(a[i]) - static_cast<int>(b[i]));
  return static_cast<double>(sum) / static_cast<double>(std::max<std::size_t>(1, a.size()));
}

}  // namespace

CameraWatch::CameraWatch(const HealthConfig& config, const std::string& sensor)
    : config_(config),
      missing_(sensor, "lost"),
      black_(sensor, "black"),
      over_exposed_(sensor, "over-exposed"),
      frozen_(sensor, "frozen") {}

bool CameraWatch::add(std::int64_t t_ns, const cv::Mat& image,
                      const std::optional<Eigen::Vector3d>& p_world) {
  missing_.look(config_, t_ns, image.empty(), "its images are missing");
  if (image.empty()) return false;
  std::vector<std::uint8_t> sample = sampled(image);
  const double level = mean(sample);
  const auto saturated = static_cast<double>(std::count_if(
      sample.begin(), sample.end(), [&](std::uint8_t v) { return v >= config_.camera.saturated_level; }));
  const double share = saturated / static_cast<double>(std::max<std::size_t>(1, sample.size()));
  const bool black = level < config_.camera.black_level;
  const bool white = share > config_.camera.max_saturated_share;
  // Without light or with too much of it there is no noise to vary.
  const bool frozen = is_frozen(sample, p_world) && !black && !white;
  last_sample_ = std::move(sample);
  black_.look(
      config_, t_ns, black,
      fmt::format("mean grey level {:.1f}, at least {:.1f} expected", level, config_.camera.black_level));
  over_exposed_.look(config_, t_ns, white,
                     fmt::format("{:.0f} % of the pixels are saturated, at most {:.0f} % expected",
                                 100 * share, 100 * config_.camera.max_saturated_share));
  frozen_.look(config_, t_ns, frozen, "the same picture again and again");
  return !black && !white && !frozen && usable();
}

/// A picture that never varied may be a still scene without noise, as long as the vehicle stands still, too.
bool CameraWatch::is_frozen(const std::vector<std::uint8_t>& sample,
                            const std::optional<Eigen::Vector3d>& p_world) {
  const bool same = sample.size() == last_sample_.size() &&
                    mean_difference(sample, last_sample_) < config_.camera.frozen_difference;
  if (!same) {
    varied_ = varied_ || !last_sample_.empty();
    p_last_change_ = p_world;
    return false;
  }
  if (!p_last_change_) p_last_change_ = p_world;
  const bool moved =
      p_world && p_last_change_ && (*p_world - *p_last_change_).norm() > config_.camera.frozen_move_m;
  return varied_ || moved;
}

bool CameraWatch::usable() const {
  return !missing_.present() && !black_.present() && !over_exposed_.present() && !frozen_.present();
}

void CameraWatch::report(std::vector<HealthFinding>& findings) const {
  for (const Symptom* symptom : {&missing_, &black_, &over_exposed_, &frozen_}) symptom->report(findings);
}

}  // namespace alight
