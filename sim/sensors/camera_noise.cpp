#include "sim/sensors/camera_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/frames.hpp"

namespace alight::sim {
namespace {

constexpr int kQuantileBits = 12;
constexpr std::size_t kQuantiles = 1U << kQuantileBits;
constexpr int kDrawsPerNumber = 64 / kQuantileBits;

/// Values of the standard normal at equally likely quantiles: a draw costs one look-up. The table is the sum
/// of the bell curve by the midpoint rule, scaled to a variance of exactly 1.
std::array<float, kQuantiles> normal_quantiles() {
  std::array<float, kQuantiles> table{};
  constexpr double kStep = 1e-4;
  double cumulated = 0;
  double x = -5;
  double squares = 0;
  for (std::size_t i = 0; i < kQuantiles; ++i) {
    const double wanted = (static_cast<double>(i) + 0.5) / static_cast<double>(kQuantiles);
    while (cumulated < wanted && x < 5) {
      cumulated +=
          kStep * std::exp(-0.5 * (x + 0.5 * kStep) * (x + 0.5 * kStep)) / std::sqrt(to_radians(360.0));
      x += kStep;
    }
    table[i] = static_cast<float>(x);
    squares += x * x;
  }
  const auto scale = static_cast<float>(std::sqrt(static_cast<double>(kQuantiles) / squares));
  for (float& value : table) value *= scale;
  return table;
}

struct Levels {
  std::array<float, 256> mean;
  std::array<float, 256> sigma;
};

Levels make_levels(const CameraConfig& config, double gain) {
  Levels levels{};
  for (std::size_t i = 0; i < 256; ++i) {
    const double mean = gain * static_cast<double>(i);
    levels.mean[i] = static_cast<float>(mean + 0.5);  // truncation then rounds
    levels.sigma[i] =
        static_cast<float>(std::sqrt(config.read_noise * config.read_noise + config.shot_noise * mean));
  }
  return levels;
}

}  // namespace

double brightness(const CameraConfig& config, double t_s) {
  return 1.0 + config.brightness_drift * std::sin(to_radians(360.0) * t_s / config.brightness_period_s);
}

void expose(cv::Mat& image, const CameraConfig& config, double gain, const CounterRandom& random) {
  static const std::array<float, kQuantiles> quantiles = normal_quantiles();
  if (gain == 1.0 && config.read_noise <= 0 && config.shot_noise <= 0) return;
  const Levels levels = make_levels(config, gain);
  const int row_bytes = image.cols * image.channels();
  const auto numbers_per_row =
      static_cast<std::uint64_t>((row_bytes + kDrawsPerNumber - 1) / kDrawsPerNumber);
  for (int v = 0; v < image.rows; ++v) {
    auto* row = image.ptr<std::uint8_t>(v);
    std::uint64_t counter = static_cast<std::uint64_t>(v) * numbers_per_row;
    for (int i = 0; i < row_bytes; ++counter) {
      std::uint64_t bits = random.bits(counter);
      for (int draw = 0; draw < kDrawsPerNumber && i < row_bytes; ++draw, ++i, bits >>= kQuantileBits) {
        const float value = levels.mean[row[i]] + levels.sigma[row[i]] * quantiles[bits & (kQuantiles - 1)];
        row[i] = static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F));
      }
    }
  }
}

}  // namespace alight::sim
