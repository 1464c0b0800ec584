#include "dataset/inspect/dataset_statistics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "foundation/order_statistics.hpp"
#include "pictures/plot_panel.hpp"

namespace alight {
namespace {

constexpr std::array<double, 8> kTimes_s = {0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0};

void count_height(double height_m, DatasetStatistics& statistics) {
  if (!std::isfinite(height_m)) {
    ++statistics.unknown_heights;
    return;
  }
  const auto bin = static_cast<std::size_t>(std::max(0.0, height_m) / statistics.height_step_m);
  if (bin >= statistics.heights.size()) statistics.heights.resize(bin + 1, 0);
  ++statistics.heights[bin];
}

/// Depth maps, added up.
class DepthTally {
 public:
  explicit DepthTally(double window_after_s) {
    for (const double t_s : kTimes_s) {
      if (t_s <= window_after_s + 1e-9) seen_.emplace_back(t_s, 0.0);
    }
  }

  void add(const SparseDepth& sparse) {
    const cv::Mat has = sparse.depth_m > 0;
    const double pixels = static_cast<double>(has.total());
    if (coverage_.empty()) coverage_ = cv::Mat::zeros(has.size(), CV_32FC1);
    cv::accumulate(has / 255, coverage_);
    covered_.push_back(cv::countNonZero(has) / pixels);
    for (auto& [t_s, sum] : seen_) {
      const cv::Mat within = has & (sparse.offset_us >= 0) & (sparse.offset_us <= 1e6 * t_s);
      sum += cv::countNonZero(within) / pixels;
    }
  }

  void finish(DatasetStatistics& statistics) {
    statistics.measured = static_cast<int>(covered_.size());
    if (covered_.empty()) return;
    const double count = static_cast<double>(covered_.size());
    statistics.coverage = coverage_ / count;
    for (const auto& [t_s, sum] : seen_) statistics.density.emplace_back(t_s, sum / count);
    statistics.covered_tenth = quantile(covered_, 0.1);
    statistics.covered_median = quantile(covered_, 0.5);
    statistics.covered_ninetieth = quantile(covered_, 0.9);
  }

 private:
  cv::Mat coverage_;
  std::vector<double> covered_;
  std::vector<std::pair<double, double>> seen_;
};

void draw_heights(const cv::Mat& picture, const DatasetStatistics& s) {
  const int most = s.heights.empty() ? 1 : *std::max_element(s.heights.begin(), s.heights.end());
  const double top_m = s.height_step_m * static_cast<double>(std::max<std::size_t>(1, s.heights.size()));
  PlotPanel panel(picture, "samples by height above take-off", {0, top_m}, {0, 1.1 * most});
  for (std::size_t i = 0; i < s.heights.size(); ++i) {
    const double from_m = s.height_step_m * static_cast<double>(i);
    panel.bar({from_m, from_m + s.height_step_m}, s.heights[i], {200, 140, 60});
  }
  panel.label_x("0 m", fmt::format("{:.0f} m", top_m));
  panel.label_y(fmt::format("up to {}", most));
}

void draw_density(const cv::Mat& picture, const DatasetStatistics& s) {
  const double end_s = s.density.empty() ? 1 : s.density.back().first;
  const double most = s.density.empty() ? 1 : std::max(1e-6, s.density.back().second);
  PlotPanel panel(picture, "pixels with depth over accumulation time", {0, end_s}, {0, 1.1 * most});
  PlotPoints points = {{0, 0}};
  points.insert(points.end(), s.density.begin(), s.density.end());
  panel.line(points, {40, 40, 220});
  panel.label_x("0 s", fmt::format("{:.1f} s", end_s));
  panel.label_y(fmt::format("up to {:.1f} %", 100 * most));
}

void draw_coverage(const cv::Mat& picture, const DatasetStatistics& s) {
  PlotPanel panel(picture, "share of samples with depth (dark 0, bright all)", {}, {});
  if (s.coverage.empty()) return;
  cv::Mat grey;
  s.coverage.convertTo(grey, CV_8U, 255);
  cv::applyColorMap(grey, grey, cv::COLORMAP_VIRIDIS);
  panel.image(grey);
}

}  // namespace

DatasetStatistics measure_dataset(const std::filesystem::path& dir, const DatasetInfo& info,
                                  int max_measured) {
  DatasetStatistics statistics;
  std::vector<std::pair<const FlightEntry*, SampleRow>> all;
  for (const FlightEntry& flight : info.flights) {
    for (const SampleRow& row : read_samples(dir, flight.name)) {
      count_height(row.height_m, statistics);
      all.emplace_back(&flight, row);
    }
  }
  statistics.samples = static_cast<int>(all.size());
  DepthTally tally(info.window_after_s);
  const std::size_t step = all.size() / static_cast<std::size_t>(std::max(1, max_measured)) + 1;
  for (std::size_t i = 0; i < all.size(); i += step)
    tally.add(read_sample(dir, *all[i].first, all[i].second, false).sparse);
  tally.finish(statistics);
  return statistics;
}

std::string format_statistics(const DatasetStatistics& s) {
  std::string text = fmt::format("{:24} {:>8}\n", "height above take-off", "samples");
  for (std::size_t i = 0; i < s.heights.size(); ++i) {
    const double from_m = s.height_step_m * static_cast<double>(i);
    if (s.heights[i] > 0)
      text +=
          fmt::format("{:>8.0f} .. {:<6.0f} m       {:8}\n", from_m, from_m + s.height_step_m, s.heights[i]);
  }
  if (s.unknown_heights > 0) text += fmt::format("{:24} {:8}\n", "unknown", s.unknown_heights);
  text += fmt::format("\n{:24} {:>8}\n", "accumulated after image", "pixels");
  for (const auto& [t_s, share] : s.density)
    text += fmt::format("{:>8.1f} s               {:>8.2f} %\n", t_s, 100 * share);
  text += fmt::format(
      "\npixels with depth over the whole window: {:.2f} % in the median sample, {:.2f} to {:.2f} % in eight "
      "of ten\n",
      100 * s.covered_median, 100 * s.covered_tenth, 100 * s.covered_ninetieth);
  text += fmt::format("(depth maps of {} of {} samples, evenly spread)\n", s.measured, s.samples);
  return text;
}

cv::Mat draw_statistics(const DatasetStatistics& statistics) {
  constexpr int kPanel_px = 440;
  cv::Mat picture(kPanel_px, 3 * kPanel_px, CV_8UC3, cv::Scalar(255, 255, 255));
  draw_heights(picture({0, 0, kPanel_px, kPanel_px}), statistics);
  draw_density(picture({kPanel_px, 0, kPanel_px, kPanel_px}), statistics);
  draw_coverage(picture({2 * kPanel_px, 0, kPanel_px, kPanel_px}), statistics);
  return picture;
}

}  // namespace alight
