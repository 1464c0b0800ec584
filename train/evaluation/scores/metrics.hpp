#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace alight {

/// What is reported about depth errors (METHOD, "Evaluation").
enum class Metric {
  kRmse,   ///< root mean square error, mm
  kMae,    ///< mean |error|, mm
  kRel,    ///< mean |error| / truth, x1000
  kDelta,  ///< pixels with max(predicted / truth, truth / predicted) < 1.25, percent
};
constexpr std::array<Metric, 4> kMetrics{Metric::kRmse, Metric::kMae, Metric::kRel, Metric::kDelta};
/// Name for files: rmse_mm, mae_mm, rel_x1000, delta_percent.
const char* name(Metric metric);
/// Name for readers, with its unit.
const char* title(Metric metric);

/// Depth errors summed over pixels.
class PixelErrors {
 public:
  /// Both positive, metres.
  void add(double predicted_m, double truth_m);
  /// As add, for a pixel that the method left unknown and that another depth stands in for.
  void add_substituted(double substitute_m, double truth_m);
  /// A pixel that nobody has a depth for; it counts in no mean.
  void add_unknown() { ++unknown_; }
  PixelErrors& operator+=(const PixelErrors& other);

  /// NaN before the first pixel.
  double value(Metric metric) const;
  std::int64_t pixels() const { return pixels_; }
  std::int64_t substituted() const { return substituted_; }  ///< of pixels()
  std::int64_t unknown() const { return unknown_; }          ///< not of pixels()

 private:
  double square_sum_m2_ = 0;
  double absolute_sum_m_ = 0;
  double relative_sum_ = 0;
  std::int64_t within_ = 0;
  std::int64_t pixels_ = 0;
  std::int64_t substituted_ = 0;
  std::int64_t unknown_ = 0;
};

/// Errors of the pixels of `mask` (CV_8UC1, empty: all) that have a true depth.
/// @param predicted_m CV_32FC1, 0 or not finite = unknown @param substitute_m stands in there; empty: nothing does
/// @param truth_m CV_32FC1, 0 = none. @throws std::invalid_argument if sizes differ
PixelErrors measure(const cv::Mat& predicted_m, const cv::Mat& substitute_m, const cv::Mat& truth_m,
                    const cv::Mat& mask);

/// A mean over flights. Pixels of one flight are no independent draws, flights are nearly; so the error of the mean is
/// taken over flights.
struct FlightMean {
  double mean = 0;            ///< NaN without a flight
  double standard_error = 0;  ///< NaN with fewer than two flights
  int flights = 0;
};
/// NaN values are left out.
FlightMean mean_over_flights(const std::vector<double>& values);

/// Errors kept apart by flight.
class FlightErrors {
 public:
  void add(const std::string& flight, const PixelErrors& errors);
  /// All pixels of all flights alike.
  PixelErrors pooled() const;
  /// Every flight alike.
  FlightMean mean(Metric metric) const;
  const std::map<std::string, PixelErrors>& flights() const { return flights_; }

 private:
  std::map<std::string, PixelErrors> flights_;
};

/// A score a sample, such as the SSIM of the reconstructed right image, kept apart by flight.
class FlightScores {
 public:
  void add(const std::string& flight, double score);
  double pooled() const;  ///< mean over all samples; NaN without one
  FlightMean mean() const;
  std::int64_t samples() const;

 private:
  struct Sum {
    double sum = 0;
    std::int64_t count = 0;
  };
  std::map<std::string, Sum> flights_;
};

}  // namespace alight
