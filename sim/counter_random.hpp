#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "foundation/split_mix.hpp"
#include "sim/random.hpp"

namespace alight::sim {

/// What a random number is for; streams of one seed are independent of each other.
enum class RandomStream : std::uint64_t {
  kLeftImage = 1,
  kRightImage,
  kLidarRange,
  kLidarDetection,
  kLidarStart,
  kAttitude,
  kGyroscope,
  kAccelerometer,
  kImuBias,
  kGpsDrift,
  kGpsWhite,
  kHeight,
  kFlightPlan,
  kSway,
  kWind,
  kLandingFault,
  kLandingStart,
  kLidarFootprint,
  kLidarReflectivity,
  kLidarAngles,
  kBoardScene,
};

/// Random numbers as a pure function of (seed, stream, counter): the same on every run and for every number
/// of threads, in whatever order they are asked for. The standard library's distributions differ between
/// implementations and are not used.
class CounterRandom {
 public:
  CounterRandom(std::uint64_t seed, RandomStream stream)
      : key_(split_mix(seed, static_cast<std::uint64_t>(stream) - 1)) {}

  /// The independent sequence number `index` of this stream, such as one a frame.
  CounterRandom child(std::uint64_t index) const {
    CounterRandom random = *this;
    random.key_ = bits(index);
    return random;
  }

  std::uint64_t bits(std::uint64_t counter) const { return split_mix(key_, counter); }

  /// Uniform in [0, 1).
  double uniform(std::uint64_t counter) const { return static_cast<double>(bits(counter) >> 11) * 0x1p-53; }
  double uniform(std::uint64_t counter, double min, double max) const {
    return min + (max - min) * uniform(counter);
  }

  /// Standard normal (Box-Muller over the halves of one number).
  double normal(std::uint64_t counter) const {
    const std::uint64_t value = bits(counter);
    const double radius = (static_cast<double>(value >> 32) + 0.5) * 0x1p-32;
    const double angle = kTwoPi * static_cast<double>(value & 0xFFFFFFFFU) * 0x1p-32;
    return std::sqrt(-2.0 * std::log(radius)) * std::cos(angle);
  }
  Eigen::Vector3d normal3(std::uint64_t counter) const {
    return {normal(3 * counter), normal(3 * counter + 1), normal(3 * counter + 2)};
  }

 private:
  std::uint64_t key_;
};

}  // namespace alight::sim
