#include "sim/objects/texture.hpp"

#include <algorithm>
#include <cmath>

#include "sim/random.hpp"

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#define ALIGHT_SIM_AVX2 1
#else
#define ALIGHT_SIM_AVX2 0
#endif
#define ALIGHT_SIM_INLINE inline __attribute__((always_inline))

namespace alight::sim {
namespace {

constexpr int kOctaves = 10;
constexpr float kFinestCell_m = 0.012F;
constexpr float kCellRatio = 2.3F;
constexpr int kFirstMixOctave = 3;  // colour changes over decimetres and more, brightness at every scale
constexpr float kMixAmplitude = 0.30F;

// Octaves are turned against each other (by the golden angle), which hides the lattice.
constexpr std::array<float, kOctaves> kCos = {1.F,      -.737369F, .087426F,  .608439F, -.984713F,
                                              .843755F, -.259604F, -.460907F, .939321F, -.924346F};
constexpr std::array<float, kOctaves> kSin = {0.F,       .675490F, -.996171F, .793601F, -.174182F,
                                              -.536728F, .965715F, -.887448F, .343044F, .381556F};

struct Octave {
  float cell_m;
  float cos;
  float sin;
  float fineness;  // 0 coarsest .. 1 finest
  float mix_weight;
  std::uint32_t salt;
};

ALIGHT_SIM_INLINE std::uint32_t lattice_bits(std::int32_t x, std::int32_t y, std::uint32_t seed) {
  std::uint32_t h =
      static_cast<std::uint32_t>(x) * 0x9E3779B1U ^ static_cast<std::uint32_t>(y) * 0x85EBCA77U ^ seed;
  h = (h ^ (h >> 15U)) * 0x2C1B3C6DU;
  return h ^ (h >> 13U);
}

// Two independent numbers in [-1, 1] from one hash: its halves.
ALIGHT_SIM_INLINE float low_half(std::uint32_t h) {
  return static_cast<float>(static_cast<std::int32_t>(h & 0xFFFFU)) * (1.F / 32768.F) - 1.F;
}
ALIGHT_SIM_INLINE float high_half(std::uint32_t h) {
  return static_cast<float>(static_cast<std::int32_t>(h >> 16U)) * (1.F / 32768.F) - 1.F;
}

ALIGHT_SIM_INLINE float blend(float a, float b, float t) { return a + (b - a) * t; }

ALIGHT_SIM_INLINE void add_octave(TextureBatch& b, std::size_t count, const Octave& octave) {
  const float per_m = 1.F / octave.cell_m;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = (b.u_m[i] * octave.cos - b.v_m[i] * octave.sin) * per_m;
    const float y = (b.u_m[i] * octave.sin + b.v_m[i] * octave.cos) * per_m;
    auto ix = static_cast<std::int32_t>(x);
    auto iy = static_cast<std::int32_t>(y);
    ix -= x < static_cast<float>(ix) ? 1 : 0;
    iy -= y < static_cast<float>(iy) ? 1 : 0;
    const float fx = x - static_cast<float>(ix);
    const float fy = y - static_cast<float>(iy);
    const float tx = fx * fx * (3.F - 2.F * fx);
    const float ty = fy * fy * (3.F - 2.F * fy);
    const std::uint32_t seed = b.seed[i] + octave.salt;
    const std::uint32_t h00 = lattice_bits(ix, iy, seed);
    const std::uint32_t h10 = lattice_bits(ix + 1, iy, seed);
    const std::uint32_t h01 = lattice_bits(ix, iy + 1, seed);
    const std::uint32_t h11 = lattice_bits(ix + 1, iy + 1, seed);
    const float first =
        blend(blend(low_half(h00), low_half(h10), tx), blend(low_half(h01), low_half(h11), tx), ty);
    const float second =
        blend(blend(high_half(h00), high_half(h10), tx), blend(high_half(h01), high_half(h11), tx), ty);
    // A cell of two pixels is drawn in full, one of less than a pixel not at all.
    const float cells = octave.cell_m / b.footprint_m[i];
    float weight = (cells - 0.9F) * (1.F / 1.1F);
    weight = weight < 0.F ? 0.F : weight;
    weight = weight > 1.F ? 1.F : weight;
    b.brightness[i] += weight * b.contrast[i] * (1.F + (b.fine_gain[i] - 1.F) * octave.fineness) * first;
    b.mix[i] += weight * octave.mix_weight * second;
  }
}

ALIGHT_SIM_INLINE void evaluate_octaves(TextureBatch& b, std::size_t count) {
  float smallest_footprint_m = b.footprint_m[0];
  for (std::size_t i = 0; i < count; ++i) {
    b.brightness[i] = 0.F;
    b.mix[i] = 0.5F;
    smallest_footprint_m = std::min(smallest_footprint_m, b.footprint_m[i]);
  }
  Octave octave{kFinestCell_m, 1.F, 0.F, 1.F, 0.F, 0U};
  for (int k = 0; k < kOctaves; ++k, octave.cell_m *= kCellRatio) {
    if (octave.cell_m <= smallest_footprint_m) continue;
    octave.cos = kCos[static_cast<std::size_t>(k)];
    octave.sin = kSin[static_cast<std::size_t>(k)];
    octave.fineness = 1.F - static_cast<float>(k) / (kOctaves - 1);
    octave.mix_weight = k >= kFirstMixOctave ? kMixAmplitude : 0.F;
    octave.salt = static_cast<std::uint32_t>(k) * 0x68E31DA4U;
    add_octave(b, count, octave);
  }
}

#if ALIGHT_SIM_AVX2
__attribute__((target("avx2"))) void evaluate_octaves_avx2(TextureBatch& b, std::size_t count) {
  evaluate_octaves(b, count);
}
#endif
void evaluate_octaves_baseline(TextureBatch& b, std::size_t count) { evaluate_octaves(b, count); }

float fraction(float x) { return x - std::floor(x); }
float clamp01(float x) { return std::clamp(x, 0.F, 1.F); }

// Share of a pixel of width `footprint` covered by a line of `width` whose axis is `distance` away.
float line_cover(float distance, float width, float footprint) {
  const float reach = clamp01((0.5F * (width + footprint) - std::abs(distance)) / footprint);
  return std::min(reach, width / std::max(width, footprint));
}
// Distance to the nearest multiple of `period`.
float to_grid(float x, float period) { return (fraction(x / period + 0.5F) - 0.5F) * period; }
// Drawn in full where the period is wide enough for the pixels, gone where it would alias.
float visibility(float period, float footprint) { return clamp01(period / footprint * 0.5F - 1.F); }

float cell_tone(float u, float v, float cell_u, float cell_v, std::uint32_t seed) {
  const auto iu = static_cast<std::int32_t>(std::floor(u / cell_u));
  const auto iv = static_cast<std::int32_t>(std::floor(v / cell_v));
  return low_half(mix_bits(lattice_bits(iu, iv, seed)));
}

struct Point {
  const Surface& surface;
  float u;
  float v;
  float footprint;
};

void draw_lanes(const Point& p, Eigen::Vector3f& albedo) {
  if (p.surface.width_m <= 0) return;
  constexpr float kLine_m = 0.12F;
  constexpr float kDash_m = 3.F;
  const float edge = line_cover(std::abs(p.v) - 0.5F * p.surface.width_m + 0.25F, kLine_m, p.footprint);
  const float dash = fraction(p.u / (2 * kDash_m)) < 0.5F ? line_cover(p.v, kLine_m, p.footprint) : 0.F;
  const float paint = std::max(edge, dash);
  albedo = albedo * (1 - paint) + Eigen::Vector3f::Constant(0.55F) * paint;
}

void draw_tiles(const Point& p, Eigen::Vector3f& albedo) {
  constexpr float kRow_m = 0.34F;
  constexpr float kColumn_m = 0.24F;
  const float row_shift = std::floor(p.v / kRow_m) * 0.5F * kColumn_m;
  const float seen = visibility(kColumn_m, p.footprint);
  const float tone = 0.18F * cell_tone(p.u + row_shift, p.v, kColumn_m, kRow_m, p.surface.seed) * seen;
  const float overlap = 0.45F * line_cover(to_grid(p.v, kRow_m), 0.05F, p.footprint);
  const float curve = 0.2F * (4.F * std::abs(fraction((p.u + row_shift) / kColumn_m) - 0.5F) - 1.F) * seen;
  albedo *= (1 + tone + curve) * (1 - overlap);
}

void draw_slabs(const Point& p, Eigen::Vector3f& albedo) {
  const float slab_m = p.surface.material == Material::kConcrete ? 3.F : 0.6F;
  const float joint_m = p.surface.material == Material::kConcrete ? 0.03F : 0.015F;
  const float tone =
      0.12F * cell_tone(p.u, p.v, slab_m, slab_m, p.surface.seed) * visibility(slab_m, p.footprint);
  const float joint = std::max(line_cover(to_grid(p.u, slab_m), joint_m, p.footprint),
                               line_cover(to_grid(p.v, slab_m), joint_m, p.footprint));
  albedo *= (1 + tone) * (1 - 0.5F * joint);
}

void draw_windows(const Point& p, Eigen::Vector3f& albedo) {
  if (p.surface.width_m <= 0) return;
  constexpr float kStorey_m = 2.9F;
  const float bays = std::max(1.F, std::floor(p.surface.width_m / 2.6F));
  const float bay_m = p.surface.width_m / bays;
  const float across = line_cover(to_grid(p.u - 0.5F * bay_m, bay_m), 1.15F, p.footprint);
  const float up = line_cover(to_grid(p.v - 0.55F * kStorey_m, kStorey_m), 1.35F, p.footprint);
  const bool inside = p.u > 0 && p.u < p.surface.width_m;
  const float pane = inside ? std::min(across, up) : 0.F;
  albedo = albedo * (1 - pane) + Eigen::Vector3f(.035F, .04F, .05F) * pane;
}

void draw_bricks(const Point& p, Eigen::Vector3f& albedo) {
  constexpr float kCourse_m = 0.083F;
  constexpr float kBrick_m = 0.25F;
  const float shifted = p.u + std::floor(p.v / kCourse_m) * 0.5F * kBrick_m;
  const float tone = 0.2F * cell_tone(shifted, p.v, kBrick_m, kCourse_m, p.surface.seed);
  const float joint = std::max(line_cover(to_grid(shifted, kBrick_m), 0.012F, p.footprint),
                               line_cover(to_grid(p.v, kCourse_m), 0.012F, p.footprint));
  albedo *= 1 + tone * visibility(kCourse_m, p.footprint);
  albedo += joint * 0.12F * Eigen::Vector3f::Ones();
  draw_windows(p, albedo);
}

void draw_furrows(const Point& p, Eigen::Vector3f& albedo) {
  if (p.surface.width_m <= 0) return;
  const float wave = 4.F * std::abs(fraction(p.v / p.surface.width_m) - 0.5F) - 1.F;
  albedo *= 1 + 0.25F * wave * visibility(p.surface.width_m, p.footprint);
}

}  // namespace

void evaluate_noise(TextureBatch& batch, std::size_t count) {
#if ALIGHT_SIM_AVX2
  static const bool has_avx2 = __builtin_cpu_supports("avx2") != 0;
  if (has_avx2) return evaluate_octaves_avx2(batch, count);
#endif
  evaluate_octaves_baseline(batch, count);
}

Eigen::Vector3f surface_albedo(const Surface& surface, float u_m, float v_m, float footprint_m,
                               float brightness, float mix) {
  const MaterialProperties& material = properties(surface.material);
  const float share = clamp01(mix);
  Eigen::Vector3f albedo = material.albedo_rgb * (1 - share) + material.albedo_alt_rgb * share;
  // Bounded below: a sum of octaves may exceed one, light may not be negative.
  albedo = albedo.cwiseProduct(surface.tint_rgb) * std::max(1.F + brightness, 0.12F);
  const Point point{surface, u_m, v_m, footprint_m};
  switch (material.pattern) {
    case Pattern::kNone:
      break;
    case Pattern::kLanes:
      draw_lanes(point, albedo);
      break;
    case Pattern::kTiles:
      draw_tiles(point, albedo);
      break;
    case Pattern::kSlabs:
      draw_slabs(point, albedo);
      break;
    case Pattern::kBricks:
      draw_bricks(point, albedo);
      break;
    case Pattern::kWindows:
      draw_windows(point, albedo);
      break;
    case Pattern::kFurrows:
      draw_furrows(point, albedo);
      break;
  }
  return albedo;
}

void triplanar_coordinates(const Eigen::Vector3f& p_world, const Eigen::Vector3f& facet_normal, float& u_m,
                           float& v_m, std::uint32_t& plane) {
  const Eigen::Vector3f n = facet_normal.cwiseAbs();
  plane = n.z() >= n.x() && n.z() >= n.y() ? 2U : (n.x() >= n.y() ? 0U : 1U);
  u_m = plane == 0 ? p_world.y() : p_world.x();
  v_m = plane == 2 ? p_world.y() : p_world.z();
}

}  // namespace alight::sim
