#include "sim/render/ray_scene.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "sim/render/packet_query.hpp"
#include "sim/value_noise.hpp"

namespace alight::sim {
namespace {

using Eigen::Vector3f;
constexpr std::size_t kPacket = 8;
using Mask = std::array<int, kPacket>;

[[noreturn]] void embree_failed(void* /*user*/, RTCError code, const char* text) {
  throw std::runtime_error("Embree error " + std::to_string(static_cast<int>(code)) + ": " +
                           (text != nullptr ? text : "no message"));
}

template <class T>
T* new_buffer(RTCGeometry geometry, RTCBufferType type, RTCFormat format, std::size_t count) {
  return static_cast<T*>(rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), count));
}

RTCGeometry triangle_geometry(RTCDevice device, const TriangleMesh& mesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = new_buffer<std::array<float, 3>>(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3,
                                                    mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    vertices[i] = {mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z()};
  }
  auto* triangles = new_buffer<std::array<std::uint32_t, 3>>(geometry, RTC_BUFFER_TYPE_INDEX,
                                                             RTC_FORMAT_UINT3, mesh.triangles.size());
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
  rtcCommitGeometry(geometry);
  return geometry;
}

void load_packet(const RayBatch& rays, std::size_t first, RTCRay8& packet) {
  const auto copy = [first](const RayBatch::Lanes& from, float* to) {
    std::memcpy(to, from.data() + first, kPacket * sizeof(float));
  };
  copy(rays.origin_x, packet.org_x);
  copy(rays.origin_y, packet.org_y);
  copy(rays.origin_z, packet.org_z);
  copy(rays.direction_x, packet.dir_x);
  copy(rays.direction_y, packet.dir_y);
  copy(rays.direction_z, packet.dir_z);
  for (std::size_t k = 0; k < kPacket; ++k) {
    packet.tnear[k] = 0;
    packet.tfar[k] = std::numeric_limits<float>::infinity();
    packet.time[k] = 0;
    packet.mask[k] = ~0U;
    packet.id[k] = 0;
    packet.flags[k] = 0;
  }
}

Mask active_lanes(std::size_t first, std::size_t count) {
  Mask mask{};
  for (std::size_t k = 0; k < kPacket; ++k) mask[k] = first + k < count ? -1 : 0;
  return mask;
}

/// Rays in the frame of what moves, each at its own time. @returns the lanes that come near it
Mask to_mover(const RayBatch& rays, std::size_t first, const Mover& mover, float reach_m, RTCRay8& packet) {
  load_packet(rays, first, packet);
  Mask valid{};
  const Eigen::Matrix3f R_mesh_world = mover.R_world_mesh().transpose();
  for (std::size_t k = 0; k < kPacket && first + k < rays.count; ++k) {
    const Vector3f origin =
        R_mesh_world * (rays.origin(first + k) - mover.p_world(static_cast<double>(rays.time_s[first + k])));
    const Vector3f direction = R_mesh_world * rays.direction(first + k);
    valid[k] = origin.cross(direction).squaredNorm() <= reach_m * reach_m * direction.squaredNorm() ? -1 : 0;
    packet.org_x[k] = origin.x();
    packet.org_y[k] = origin.y();
    packet.org_z[k] = origin.z();
    packet.dir_x[k] = direction.x();
    packet.dir_y[k] = direction.y();
    packet.dir_z[k] = direction.z();
  }
  return valid;
}

}  // namespace

void RayBatch::add(const Vector3f& origin, const Vector3f& direction, float t_s) {
  origin_x[count] = origin.x();
  origin_y[count] = origin.y();
  origin_z[count] = origin.z();
  direction_x[count] = direction.x();
  direction_y[count] = direction.y();
  direction_z[count] = direction.z();
  time_s[count] = t_s;
  ++count;
}

struct RayScene::Embree {
  // One building thread: the tree, and with it which of two equally near triangles wins, is then always the
  // same. AVX2 at most: machines with and without AVX-512 then give the same bits.
  RTCDevice device = rtcNewDevice("threads=1,max_isa=avx2");
  RTCScene scene = nullptr;
  std::vector<RTCScene> mesh_scenes;   // null where a mesh is not instanced
  std::vector<float> mover_reaches_m;  // of a mover's mesh from its origin

  explicit Embree(const World& world) : mesh_scenes(world.meshes().size(), nullptr) {
    if (device == nullptr) throw std::runtime_error("Embree cannot start on this machine");
    rtcSetDeviceErrorFunction(device, embree_failed, nullptr);
    scene = new_scene();
    for (std::size_t i = 0; i < world.placements().size(); ++i) {
      if (world.meshes()[world.placements()[i].mesh].triangles.empty()) continue;
      RTCGeometry geometry = placed_geometry(world, world.placements()[i]);
      rtcAttachGeometryByID(scene, geometry, static_cast<unsigned>(i));
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene);
    for (const Mover& mover : world.movers()) {
      const TriangleMesh& mesh = world.meshes()[mover.mesh()];
      scene_of(mesh, mover.mesh());
      float reach_m = 0;
      for (const Vector3f& vertex : mesh.vertices) reach_m = std::max(reach_m, vertex.norm());
      mover_reaches_m.push_back(reach_m);
    }
  }
  ~Embree() {
    for (RTCScene mesh_scene : mesh_scenes) {
      if (mesh_scene != nullptr) rtcReleaseScene(mesh_scene);
    }
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;

 private:
  RTCScene new_scene() const {
    RTCScene result = rtcNewScene(device);
    rtcSetSceneFlags(result, RTC_SCENE_FLAG_ROBUST);
    return result;
  }

  RTCScene scene_of(const TriangleMesh& mesh, std::size_t index) {
    RTCScene& result = mesh_scenes[index];
    if (result != nullptr) return result;
    result = new_scene();
    RTCGeometry geometry = triangle_geometry(device, mesh);
    rtcAttachGeometry(result, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(result);
    return result;
  }

  // A mesh that stands unmoved goes straight into the scene; all others are instanced.
  RTCGeometry placed_geometry(const World& world, const Placement& placement) {
    const TriangleMesh& mesh = world.meshes()[placement.mesh];
    if (placement.T_world_mesh.matrix().isIdentity(0)) return triangle_geometry(device, mesh);
    RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, scene_of(mesh, placement.mesh));
    const Eigen::Matrix<float, 3, 4, Eigen::ColMajor> T = placement.T_world_mesh.matrix().topRows<3>();
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, T.data());
    rtcCommitGeometry(instance);
    return instance;
  }
};

RayScene::RayScene(const World& world) : world_(world), embree_(std::make_unique<Embree>(world)) {
  for (const Placement& placement : world.placements()) {
    normal_matrices_.emplace_back(placement.T_world_mesh.linear().inverse().transpose());
  }
  for (const Mover& mover : world.movers()) normal_matrices_.push_back(mover.R_world_mesh());
}

RayScene::~RayScene() = default;

void RayScene::intersect(const RayBatch& rays, bool coherent, RayHits& hits) const {
  for (std::size_t first = 0; first < rays.count; first += kPacket) {
    RTCRayHit8 packet;
    load_packet(rays, first, packet.ray);
    for (std::size_t k = 0; k < kPacket; ++k) {
      packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    alignas(32) const Mask valid = active_lanes(first, rays.count);
    intersect_packet(embree_->scene, valid.data(), coherent, packet);
    for (std::size_t k = 0; k < kPacket && first + k < rays.count; ++k) {
      RayHit& hit = hits[first + k];
      hit = {};
      if (packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
      const bool instanced = packet.hit.instID[0][k] != RTC_INVALID_GEOMETRY_ID;
      hit = {packet.ray.tfar[k], packet.hit.u[k], packet.hit.v[k], packet.hit.primID[k],
             instanced ? packet.hit.instID[0][k] : packet.hit.geomID[k]};
    }
    if (!world_.movers().empty()) meet_movers(rays, first, hits);
  }
}

void RayScene::meet_movers(const RayBatch& rays, std::size_t first, RayHits& hits) const {
  for (std::size_t i = 0; i < world_.movers().size(); ++i) {
    const Mover& mover = world_.movers()[i];
    RTCRayHit8 packet;
    alignas(32) const Mask valid = to_mover(rays, first, mover, embree_->mover_reaches_m[i], packet.ray);
    if (valid == Mask{}) continue;
    for (std::size_t k = 0; k < kPacket; ++k) {
      const float before = first + k < rays.count ? hits[first + k].distance : 0;
      if (before > 0) packet.ray.tfar[k] = before;
      packet.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    intersect_packet(embree_->mesh_scenes[mover.mesh()], valid.data(), false, packet);
    for (std::size_t k = 0; k < kPacket && first + k < rays.count; ++k) {
      if (valid[k] == 0 || packet.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
      hits[first + k] = {packet.ray.tfar[k], packet.hit.u[k], packet.hit.v[k], packet.hit.primID[k],
                         static_cast<std::uint32_t>(world_.placements().size() + i)};
    }
  }
}

void RayScene::shade_by_movers(const RayBatch& rays, std::size_t first,
                               std::array<bool, RayBatch::kCapacity>& blocked) const {
  for (std::size_t i = 0; i < world_.movers().size(); ++i) {
    const Mover& mover = world_.movers()[i];
    RTCRay8 packet;
    alignas(32) const Mask valid = to_mover(rays, first, mover, embree_->mover_reaches_m[i], packet);
    if (valid == Mask{}) continue;
    occlude_packet(embree_->mesh_scenes[mover.mesh()], valid.data(), false, packet);
    for (std::size_t k = 0; k < kPacket && first + k < rays.count; ++k)
      blocked[first + k] = blocked[first + k] || (valid[k] != 0 && packet.tfar[k] < 0);
  }
}

void RayScene::occluded(const RayBatch& rays, std::array<bool, RayBatch::kCapacity>& blocked) const {
  for (std::size_t first = 0; first < rays.count; first += kPacket) {
    RTCRay8 packet;
    load_packet(rays, first, packet);
    alignas(32) const Mask valid = active_lanes(first, rays.count);
    occlude_packet(embree_->scene, valid.data(), true, packet);
    for (std::size_t k = 0; k < kPacket && first + k < rays.count; ++k)
      blocked[first + k] = packet.tfar[k] < 0;
    if (!world_.movers().empty()) shade_by_movers(rays, first, blocked);
  }
}

// Frays the cover map's 10 cm steps where two covers meet.
const Surface& RayScene::cover_surface(const Vector3f& p_world, std::uint32_t& index) const {
  constexpr double kFray_m = 0.08;
  constexpr double kKnots_per_m = 18;
  const Terrain& terrain = *world_.terrain();
  double x_m = p_world.x();
  double y_m = p_world.y();
  if (terrain.is_cover_border(x_m, y_m)) {
    const double fray_x_m = kFray_m * value_noise(x_m * kKnots_per_m, y_m * kKnots_per_m, 11U);
    y_m += kFray_m * value_noise(x_m * kKnots_per_m, y_m * kKnots_per_m, 12U);
    x_m += fray_x_m;
  }
  index = terrain.cover(x_m, y_m);
  return world_.surfaces()[index];
}

SurfacePoint RayScene::surface_point(const RayHit& hit, const Vector3f& origin,
                                     const Vector3f& direction) const {
  const std::size_t still = world_.placements().size();
  const Mover* const mover = hit.placement < still ? nullptr : &world_.movers()[hit.placement - still];
  const TriangleMesh& mesh =
      world_.meshes()[mover != nullptr ? mover->mesh() : world_.placements()[hit.placement].mesh];
  const auto& t = mesh.triangles[hit.triangle];
  const Vector3f& a = mesh.vertices[t[0]];
  const Vector3f facet = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
  const Vector3f smooth =
      mesh.normals[t[0]] * (1 - hit.u - hit.v) + mesh.normals[t[1]] * hit.u + mesh.normals[t[2]] * hit.v;
  SurfacePoint point;
  point.p_world = origin + direction * hit.distance;
  point.facet_normal = (normal_matrices_[hit.placement] * facet).normalized();
  point.shading_normal = (normal_matrices_[hit.placement] * smooth).normalized();
  if (point.facet_normal.dot(direction) > 0) {
    point.facet_normal = -point.facet_normal;
    point.shading_normal = -point.shading_normal;
  }
  point.tint_rgb = mover != nullptr ? mover->tint_rgb() : world_.placements()[hit.placement].tint_rgb;
  point.placement = hit.placement;
  point.surface_index = mesh.triangle_surfaces[hit.triangle];
  const bool is_ground = point.surface_index == TriangleMesh::kGroundCover;
  point.surface = is_ground ? &cover_surface(point.p_world, point.surface_index)
                            : &world_.surfaces()[point.surface_index];
  return point;
}

}  // namespace alight::sim
