#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "geometry/camera.hpp"
#include "sim/world/world.hpp"

namespace alight::sim {

/// How images are made.
struct RendererConfig {
  double exposure = 1.0;  ///< factor on the light before the sRGB curve; 1 puts sunlit grass near mid grey
  int edge_samples = 3;   ///< rays per pixel at edges of objects and shadows (1: no smoothing of edges)
  int threads = 0;        ///< 0: as many as the machine has; images do not depend on it
};
void bind(Binder& b, RendererConfig& c);

/// One camera image with its truth.
struct View {
  cv::Mat image;    ///< CV_8UC3 BGR, sRGB, free of noise and blur
  cv::Mat depth_m;  ///< CV_32FC1 plane depth of the pixel's centre ray, 0 = sky; empty if not asked for
};

/// Where a ray ended.
struct Hit {
  bool hit = false;
  double range_m = 0;  ///< along the (unit) direction
  Material material = Material::kGrass;
  float reflectivity = 0;  ///< diffuse, 905 nm, 0..1; 0 where nothing comes back (water)
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< unit, world, towards the ray's origin
};

/// Ray caster over one world (Embree). Const use from many threads is safe. Results do not depend on the
/// number of threads. Shading is independent of the viewing direction (Lambert, one sun with shadows, a sky
/// dome), so that two cameras see the same paint.
class Renderer {
 public:
  /// `world` must outlive the renderer.
  explicit Renderer(const World& world, const RendererConfig& config = {});
  ~Renderer();
  Renderer(Renderer&&) noexcept;
  Renderer& operator=(Renderer&&) noexcept;

  const World& world() const;

  /// An ideal pinhole image. @param t_s from the start of the flight, here and below: where what moves is
  View render_camera(const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_world_camera,
                     bool with_depth, double t_s = 0) const;

  /// One ray; `direction_world` need not be of unit length, the range is in metres all the same.
  Hit cast(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world, double t_s = 0) const;

  /// Many rays, each with its own origin, in packets; out[i] belongs to origins[i], directions[i]. Runs on
  /// the calling thread. @param times_s of each ray; empty: all at the start of the flight
  /// @throws std::invalid_argument if the lengths differ
  void cast_many(const std::vector<Eigen::Vector3d>& origins_world,
                 const std::vector<Eigen::Vector3d>& directions_world, std::vector<Hit>& out,
                 const std::vector<double>& times_s = {}) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace alight::sim
