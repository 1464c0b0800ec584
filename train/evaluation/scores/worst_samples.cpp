#include "train/evaluation/scores/worst_samples.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "foundation/order_statistics.hpp"
#include "geometry/depth_map.hpp"
#include "infer/replay/overlay.hpp"
#include "pictures/picture_file.hpp"

namespace alight {
namespace {

constexpr int kBarWidth_px = 10;

/// The value that `share` of the pixels of `mask` do not exceed; 0 without one.
double percentile(const cv::Mat& map, const cv::Mat& mask, double share) {
  std::vector<float> values;
  for (int v = 0; v < map.rows; ++v) {
    for (int u = 0; u < map.cols; ++u) {
      if (mask.at<std::uint8_t>(v, u) != 0) values.push_back(map.at<float>(v, u));
    }
  }
  if (values.empty()) return 0;
  return static_cast<double>(quantile(values, share));
}

/// Values 0..limit as colours from dark to bright; black outside the mask.
cv::Mat colour_errors(const cv::Mat& error_m, const cv::Mat& mask, double limit_m) {
  cv::Mat grey;
  error_m.convertTo(grey, CV_8UC1, 255 / limit_m);
  cv::Mat colours;
  cv::applyColorMap(grey, colours, cv::COLORMAP_VIRIDIS);
  colours.setTo(cv::Scalar::all(0), ~mask);
  return colours;
}

/// The largest value on top, 0 at the bottom.
cv::Mat scale_bar(int height) {
  cv::Mat ramp(height, kBarWidth_px, CV_32FC1);
  for (int v = 0; v < height; ++v) {
    ramp.row(v).setTo(1 - static_cast<double>(v) / std::max(1, height - 1));
  }
  return colour_errors(ramp, cv::Mat(ramp.size(), CV_8UC1, cv::Scalar(255)), 1);
}

Panel error_panel(const cv::Mat& predicted_m, const cv::Mat& truth_m) {
  const cv::Mat known = (truth_m > 0) & (predicted_m > 0);
  cv::Mat error_m;
  cv::absdiff(predicted_m, truth_m, error_m);
  const double limit_m = std::max(0.01, percentile(error_m, known, 0.99));
  cv::Mat image;
  cv::hconcat(colour_errors(error_m, known, limit_m), scale_bar(truth_m.rows), image);
  return {fmt::format("error: 0 (dark) to {:.2f} m", limit_m), image};
}

ErrorPicture picture_of(const SampleError& sample_error, const DepthMethod& method, SampleSource& source,
                        const EvaluationConfig& config, const Feeding& feeding) {
  const std::size_t index = sample_error.item.index;
  const DepthSample sample = source.get(index);
  const torch::Tensor fed_m = feed(sample, feeding, static_cast<std::uint64_t>(config.seed) + index);
  return {fmt::format("{}: {:.0f} mm", sample_error.item.flight, sample_error.rmse_mm),
          tensor_to_image(sample.left), tensor_to_depth(fed_m),
          tensor_to_depth(method.complete(sample, fed_m)),
          tensor_to_depth(sample.dense.defined() ? sample.dense : sample.sparse)};
}

}  // namespace

cv::Mat draw_errors(const ErrorPicture& picture) {
  const cv::Mat known = picture.truth_m > 0;
  const double min_m = percentile(picture.truth_m, known, 0.01);
  const double max_m = std::max(min_m + 0.1, percentile(picture.truth_m, known, 0.99));
  const auto depth = [&](const cv::Mat& depth_m) { return colour_depth(depth_m, min_m, max_m); };
  return panel_strip(
      {{picture.title, picture.left},
       {fmt::format("fed: {} points", cv::countNonZero(picture.fed_m)), depth(picture.fed_m)},
       {"prediction", depth(picture.predicted_m)},
       {fmt::format("truth: {:.1f} (red) to {:.1f} m (blue)", min_m, max_m), depth(picture.truth_m)},
       error_panel(picture.predicted_m, picture.truth_m)});
}

void write_worst_samples(const EvaluationReport& report, const DepthMethod& first_method,
                         SampleSource& source, const EvaluationConfig& config, int count,
                         const std::filesystem::path& dir) {
  std::vector<SampleError> worst;
  std::copy_if(report.first_method.begin(), report.first_method.end(), std::back_inserter(worst),
               [](const SampleError& error) { return std::isfinite(error.rmse_mm); });
  std::stable_sort(worst.begin(), worst.end(),
                   [](const SampleError& a, const SampleError& b) { return a.rmse_mm > b.rmse_mm; });
  worst.resize(std::min(worst.size(), static_cast<std::size_t>(std::max(0, count))));
  const auto feeding =
      std::find_if(report.feedings.begin(), report.feedings.end(),
                   [&](const Feeding& candidate) { return candidate.name() == config.picture_feeding; });
  for (std::size_t i = 0; i < worst.size(); ++i) {
    const std::string file = fmt::format("{:02}_{}_{}.png", i + 1, worst[i].item.flight, worst[i].item.index);
    write_picture(dir / file, draw_errors(picture_of(worst[i], first_method, source, config, *feeding)));
  }
}

}  // namespace alight
