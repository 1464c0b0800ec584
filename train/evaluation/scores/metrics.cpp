#include "train/evaluation/scores/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace alight {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDeltaLimit = 1.25;

}  // namespace

const char* name(Metric metric) {
  switch (metric) {
    case Metric::kRmse:
      return "rmse_mm";
    case Metric::kMae:
      return "mae_mm";
    case Metric::kRel:
      return "rel_x1000";
    case Metric::kDelta:
      break;
  }
  return "delta_percent";
}

const char* title(Metric metric) {
  switch (metric) {
    case Metric::kRmse:
      return "RMSE [mm]";
    case Metric::kMae:
      return "MAE [mm]";
    case Metric::kRel:
      return "REL [x1000]";
    case Metric::kDelta:
      break;
  }
  return "delta < 1.25 [%]";
}

void PixelErrors::add(double predicted_m, double truth_m) {
  const double error_m = std::abs(predicted_m - truth_m);
  square_sum_m2_ += error_m * error_m;
  absolute_sum_m_ += error_m;
  relative_sum_ += error_m / truth_m;
  within_ += std::max(predicted_m / truth_m, truth_m / predicted_m) < kDeltaLimit ? 1 : 0;
  ++pixels_;
}

void PixelErrors::add_substituted(double substitute_m, double truth_m) {
  add(substitute_m, truth_m);
  ++substituted_;
}

PixelErrors& PixelErrors::operator+=(const PixelErrors& other) {
  square_sum_m2_ += other.square_sum_m2_;
  absolute_sum_m_ += other.absolute_sum_m_;
  relative_sum_ += other.relative_sum_;
  within_ += other.within_;
  pixels_ += other.pixels_;
  substituted_ += other.substituted_;
  unknown_ += other.unknown_;
  return *this;
}

double PixelErrors::value(Metric metric) const {
  if (pixels_ == 0) return kNan;
  const auto count = static_cast<double>(pixels_);
  switch (metric) {
    case Metric::kRmse:
      return 1000 * std::sqrt(square_sum_m2_ / count);
    case Metric::kMae:
      return 1000 * absolute_sum_m_ / count;
    case Metric::kRel:
      return 1000 * relative_sum_ / count;
    case Metric::kDelta:
      break;
  }
  return 100 * static_cast<double>(within_) / count;
}

PixelErrors measure(const cv::Mat& predicted_m, const cv::Mat& substitute_m, const cv::Mat& truth_m,
                    const cv::Mat& mask) {
  const auto fits = [&](const cv::Mat& map) { return map.empty() || map.size() == truth_m.size(); };
  if (predicted_m.size() != truth_m.size() || !fits(substitute_m) || !fits(mask)) {
    throw std::invalid_argument("measure: prediction, substitute, truth and mask must have one size");
  }
  const auto known = [](float depth_m) { return std::isfinite(depth_m) && depth_m > 0; };
  PixelErrors errors;
  for (int v = 0; v < truth_m.rows; ++v) {
    const float* truth = truth_m.ptr<float>(v);
    const float* predicted = predicted_m.ptr<float>(v);
    const float* substitute = substitute_m.empty() ? nullptr : substitute_m.ptr<float>(v);
    const std::uint8_t* counts = mask.empty() ? nullptr : mask.ptr<std::uint8_t>(v);
    for (int u = 0; u < truth_m.cols; ++u) {
      if (!(truth[u] > 0) || (counts != nullptr && counts[u] == 0)) continue;
      if (known(predicted[u])) {
        errors.add(static_cast<double>(predicted[u]), static_cast<double>(truth[u]));
      } else if (substitute != nullptr && known(substitute[u])) {
        errors.add_substituted(static_cast<double>(substitute[u]), static_cast<double>(truth[u]));
      } else {
        errors.add_unknown();
      }
    }
  }
  return errors;
}

FlightMean mean_over_flights(const std::vector<double>& values) {
  FlightMean result{0, kNan, 0};
  double square_sum = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    ++result.flights;
    const double step = value - result.mean;  // Welford 1962
    result.mean += step / result.flights;
    square_sum += step * (value - result.mean);
  }
  if (result.flights == 0) result.mean = kNan;
  if (result.flights >= 2) {
    result.standard_error = std::sqrt(square_sum / (result.flights - 1) / result.flights);
  }
  return result;
}

void FlightErrors::add(const std::string& flight, const PixelErrors& errors) { flights_[flight] += errors; }

PixelErrors FlightErrors::pooled() const {
  PixelErrors all;
  for (const auto& [flight, errors] : flights_) all += errors;
  return all;
}

FlightMean FlightErrors::mean(Metric metric) const {
  std::vector<double> values;
  for (const auto& [flight, errors] : flights_) values.push_back(errors.value(metric));
  return mean_over_flights(values);
}

void FlightScores::add(const std::string& flight, double score) {
  Sum& sum = flights_[flight];
  sum.sum += score;
  ++sum.count;
}

double FlightScores::pooled() const {
  double sum = 0;
  for (const auto& [flight, part] : flights_) sum += part.sum;
  return samples() == 0 ? kNan : sum / static_cast<double>(samples());
}

FlightMean FlightScores::mean() const {
  std::vector<double> values;
  for (const auto& [flight, part] : flights_) values.push_back(part.sum / static_cast<double>(part.count));
  return mean_over_flights(values);
}

std::int64_t FlightScores::samples() const {
  std::int64_t count = 0;
  for (const auto& [flight, part] : flights_) count += part.count;
  return count;
}

}  // namespace alight
