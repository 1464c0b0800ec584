#include "sim/render/shading.hpp"

#include <algorithm>
#include <cmath>

#include "sim/objects/texture.hpp"
#include "sim/random.hpp"

namespace alight::sim {
namespace {

using Eigen::Vector3f;
constexpr std::size_t kCapacity = RayBatch::kCapacity;
static_assert(kCapacity == TextureBatch::kCapacity);
constexpr float kSurfaceOffset_m = 0.003F;  // shadow rays start this far off, over float rounding at 200 m
constexpr float kLeafTransmission = 0.45F;

// Light of a clear day: sun warm, sky blue, what the ground throws back brownish. Relative units.
const Vector3f kSunLight(1.85F, 1.72F, 1.53F);
const Vector3f kSkyLight(0.36F, 0.43F, 0.53F);
const Vector3f kGroundLight(0.14F, 0.13F, 0.10F);
const Vector3f kSkyColour(0.55F, 0.68F, 0.85F);

/// The rays that hit something, closed up.
struct Hits {
  std::size_t count = 0;
  std::array<std::size_t, kCapacity> ray{};
  std::array<SurfacePoint, kCapacity> point{};
  std::array<Vector3f, kCapacity> albedo{};
  std::array<float, kCapacity> sun{};  // cosine to the sun where it is seen, 0 in shadow
};

bool is_leafy(Material material) {
  return material == Material::kFoliage || material == Material::kNeedles || material == Material::kCrop;
}

void texture_lane(const SurfacePoint& point, const Vector3f& direction, float distance, float pixel_rad,
                  std::size_t i, TextureBatch& batch) {
  const Surface& surface = *point.surface;
  std::uint32_t plane = 2;
  if (surface.framed) {
    batch.u_m[i] = (point.p_world - surface.origin).dot(surface.u_axis);
    batch.v_m[i] = (point.p_world - surface.origin).dot(surface.v_axis);
  } else {
    triplanar_coordinates(point.p_world, point.facet_normal, batch.u_m[i], batch.v_m[i], plane);
  }
  // A slanted pixel is long: the geometric mean of its two sides keeps detail across without much aliasing
  // along.
  const float length = direction.norm();
  const float slant = std::max(-point.facet_normal.dot(direction) / length, 0.15F);
  batch.footprint_m[i] = distance * length * pixel_rad / std::sqrt(slant);
  batch.contrast[i] = properties(surface.material).contrast;
  batch.fine_gain[i] = properties(surface.material).fine_gain;
  batch.seed[i] = mix_bits(surface.seed * 3U + plane);
}

void paint(const RayBatch& rays, const ShadedRays& out, float pixel_rad, Hits& hits) {
  TextureBatch batch;
  for (std::size_t i = 0; i < hits.count; ++i) {
    const std::size_t ray = hits.ray[i];
    texture_lane(hits.point[i], rays.direction(ray), out.distance[ray], pixel_rad, i, batch);
  }
  evaluate_noise(batch, hits.count);
  for (std::size_t i = 0; i < hits.count; ++i) {
    hits.albedo[i] = surface_albedo(*hits.point[i].surface, batch.u_m[i], batch.v_m[i], batch.footprint_m[i],
                                    batch.brightness[i], batch.mix[i])
                         .cwiseProduct(hits.point[i].tint_rgb);
  }
}

// Cosine to the sun if nothing were in between.
float open_sunlight(const SurfacePoint& point, const Vector3f& sun) {
  const float cosine = point.shading_normal.dot(sun);
  if (is_leafy(point.surface->material)) return cosine > 0 ? cosine : -kLeafTransmission * cosine;
  return point.facet_normal.dot(sun) > 0 ? std::max(cosine, 0.F) : 0.F;
}

void cast_shadows(const RayScene& scene, const RayBatch& seen, Hits& hits) {
  const Vector3f sun = scene.world().sun_direction().cast<float>();
  RayBatch rays;
  std::array<std::size_t, kCapacity> owner{};
  for (std::size_t i = 0; i < hits.count; ++i) {
    const SurfacePoint& point = hits.point[i];
    hits.sun[i] = open_sunlight(point, sun);
    if (hits.sun[i] <= 0) continue;
    const float off_m = point.facet_normal.dot(sun) > 0 ? kSurfaceOffset_m : -kSurfaceOffset_m;
    owner[rays.count] = i;
    rays.add(point.p_world + point.facet_normal * off_m, sun, seen.time_s[hits.ray[i]]);
  }
  std::array<bool, kCapacity> blocked{};
  scene.occluded(rays, blocked);
  for (std::size_t k = 0; k < rays.count; ++k) {
    if (blocked[k]) hits.sun[owner[k]] = 0;
  }
}

// Inside a crown everything is an edge: there only its outline counts.
std::uint32_t edge_key(const SurfacePoint& point, bool sunlit) {
  const bool leafy = is_leafy(point.surface->material);
  const std::uint32_t bits = mix_bits(leafy ? 0xFFFFU : point.surface_index, point.placement) & 0x7FFFFFFEU;
  return bits | (sunlit && !leafy ? 1U : 0U);
}

}  // namespace

void shade(const RayScene& scene, const RayBatch& rays, float pixel_rad, ShadedRays& out) {
  RayHits ray_hits;
  scene.intersect(rays, true, ray_hits);
  Hits hits;
  for (std::size_t i = 0; i < rays.count; ++i) {
    out.distance[i] = ray_hits[i].distance;
    out.light_rgb[i] = kSkyColour * scene.world().daylight();
    out.key[i] = ShadedRays::kSky;
    if (ray_hits[i].distance <= 0) continue;
    hits.point[hits.count] = scene.surface_point(ray_hits[i], rays.origin(i), rays.direction(i));
    hits.ray[hits.count++] = i;
  }
  if (hits.count == 0) return;
  const float daylight = scene.world().daylight();
  paint(rays, out, pixel_rad, hits);
  cast_shadows(scene, rays, hits);
  for (std::size_t i = 0; i < hits.count; ++i) {
    const float up = 0.5F + 0.5F * hits.point[i].shading_normal.z();
    const Vector3f light = daylight * (kSunLight * hits.sun[i] + kSkyLight * up + kGroundLight * (1 - up));
    out.light_rgb[hits.ray[i]] = hits.albedo[i].cwiseProduct(light);
    out.key[hits.ray[i]] = edge_key(hits.point[i], hits.sun[i] > 0);
  }
}

}  // namespace alight::sim
