#include "sim/site/relief.hpp"

#include "sim/random.hpp"
#include "sim/value_noise.hpp"

namespace alight::sim {

Relief::Relief(const std::array<ReliefOctave, 4>& octaves, int seed)
    : octaves_(octaves), seed_(static_cast<std::uint32_t>(seed)) {}

double Relief::smooth_m(const Eigen::Vector2d& p) const {
  const ReliefOctave& first = octaves_.front();
  const auto seed = mix_bits(seed_, 77U);
  // Two turned copies: one lattice alone shows its axes as ridges.
  return first.amplitude_m * 0.7 *
         (value_noise(p.x() / first.wavelength_m, p.y() / first.wavelength_m, seed) +
          value_noise((0.6 * p.x() + 0.8 * p.y()) / first.wavelength_m + 7.3,
                      (-0.8 * p.x() + 0.6 * p.y()) / first.wavelength_m, seed + 1));
}

double Relief::height_m(const Eigen::Vector2d& p) const {
  double height_m = smooth_m(p);
  auto seed = mix_bits(seed_, 78U);
  for (std::size_t i = 1; i < octaves_.size(); ++i) {
    const ReliefOctave& octave = octaves_[i];
    height_m +=
        octave.amplitude_m * value_noise(p.x() / octave.wavelength_m, p.y() / octave.wavelength_m, seed++);
  }
  return height_m;
}

}  // namespace alight::sim
