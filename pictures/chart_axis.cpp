#include "pictures/chart_axis.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace alight {
namespace {

/// The smallest of 1, 2, 5 times a power of ten that is not below `step`.
double round_up(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= step * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::vector<AxisTick> linear_ticks(double min, double max, bool whole) {
  constexpr double kTicks = 6;  // at most, about
  double step = round_up((max - min) / kTicks);
  if (whole) step = std::max(step, 1.0);
  std::vector<AxisTick> ticks;
  // Plus zero: ceil gives -0 just below zero, which would be printed so.
  for (double i = std::ceil(min / step - 1e-9) + 0.0; i * step <= max + 1e-9 * step; ++i) {
    ticks.push_back({i * step, tick_label(i * step)});
  }
  return ticks;
}

/// `factors` times every power of ten within the range.
std::vector<AxisTick> power_ticks(double min, double max, const std::vector<double>& factors) {
  std::vector<AxisTick> ticks;
  for (double power = std::floor(std::log10(min)); power <= std::log10(max); ++power) {
    for (const double factor : factors) {
      const double value = factor * std::pow(10.0, power);
      if (value >= min && value <= max) ticks.push_back({value, tick_label(value)});
    }
  }
  return ticks;
}

std::vector<AxisTick> logarithmic_ticks(double min, double max) {
  constexpr std::size_t kMaxTicks = 8;
  std::vector<AxisTick> ticks = power_ticks(min, max, {1, 2, 5});
  if (ticks.size() < 3) return linear_ticks(min, max, false);
  if (ticks.size() > kMaxTicks) ticks = power_ticks(min, max, {1});
  std::vector<AxisTick> kept;
  const std::size_t step = ticks.size() / kMaxTicks + 1;
  for (std::size_t i = 0; i < ticks.size(); i += step) kept.push_back(ticks[i]);
  return kept;
}

}  // namespace

double ChartAxis::share(double value) const {
  if (logarithmic) return std::log(value / min) / std::log(max / min);
  return (value - min) / (max - min);
}

ChartAxis linear_axis(double min, double max, bool whole) {
  if (!(max > min)) {
    const double widen = whole || min == 0 ? 1 : 0.1 * std::abs(min);
    min -= widen;
    max += widen;
  }
  return {min, max, false, linear_ticks(min, max, whole)};
}

ChartAxis logarithmic_axis(double min, double max) {
  if (!(min > 0 && max >= min)) throw std::invalid_argument("logarithmic_axis: expected 0 < min <= max");
  const double widen = std::max(std::pow(max / min, 0.05), 1.02);
  return {min / widen, max * widen, true, logarithmic_ticks(min / widen, max * widen)};
}

std::string tick_label(double value) {
  std::string label = fmt::format("{:.6g}", value);
  const std::size_t exponent = label.find('e');
  if (exponent == std::string::npos) return label;
  // "1e-05", "1e+06": the sign stays where it is minus, leading zeros go.
  const std::size_t digits = label.find_first_not_of("+-0", exponent + 1);
  return label.substr(0, exponent + 1) + (label[exponent + 1] == '-' ? "-" : "") + label.substr(digits);
}

}  // namespace alight
