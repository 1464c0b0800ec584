#include "sim/render/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "foundation/config_reader.hpp"
#include "foundation/parallel_rows.hpp"
#include "sim/render/ray_scene.hpp"
#include "sim/render/shading.hpp"

namespace alight::sim {
namespace {

using Eigen::Vector3f;
constexpr int kTile_px = 8;  // a tile fills a batch
static_assert(kTile_px * kTile_px == RayBatch::kCapacity);
constexpr std::size_t kSrgbLevels = 4096;

std::array<std::uint8_t, kSrgbLevels> srgb_table() {
  std::array<std::uint8_t, kSrgbLevels> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double linear = static_cast<double>(i) / (kSrgbLevels - 1);
    const double value = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    table[i] = static_cast<std::uint8_t>(std::lround(255 * value));
  }
  return table;
}

/// The extra rays of an edge pixel lie on a ring around its centre ray, turned against the axes.
Eigen::Vector2d sub_pixel(int extra, int extras) {
  constexpr double kRing_px = 0.36;
  const double angle = 0.4 + 6.283185307179586 * extra / extras;
  return {kRing_px * std::cos(angle), kRing_px * std::sin(angle)};
}

/// One image in the making.
class Frame {
 public:
  Frame(const RayScene& scene, const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_world_camera,
        double t_s)
      : scene_(scene),
        intrinsics_(intrinsics),
        R_world_camera_(T_world_camera.linear()),
        origin_(T_world_camera.translation().cast<float>()),
        t_s_(static_cast<float>(t_s)),
        pixel_rad_(static_cast<float>(1.0 / intrinsics.fx_px)),
        light_(intrinsics.size(), CV_32FC3),
        depth_m_(intrinsics.size(), CV_32FC1),
        key_(intrinsics.size(), CV_32SC1) {}

  cv::Mat depth_m() const { return depth_m_; }
  int tile_rows() const { return (intrinsics_.height_px + kTile_px - 1) / kTile_px; }
  void trace_tile_row(int tile_row);
  void smooth_row(int row, int samples);
  void encode_row(int row, float exposure, cv::Mat& image) const;

 private:
  void trace_tile(int first_row, int first_column);
  bool is_edge(int row, int column) const;
  Vector3f direction(double u_px, double v_px) const {
    return (R_world_camera_ * intrinsics_.ray(u_px, v_px)).cast<float>();
  }

  const RayScene& scene_;
  const PinholeIntrinsics& intrinsics_;
  Eigen::Matrix3d R_world_camera_;
  Vector3f origin_;
  float t_s_;
  float pixel_rad_;
  cv::Mat light_;    // CV_32FC3 linear RGB
  cv::Mat depth_m_;  // CV_32FC1
  cv::Mat key_;      // CV_32SC1
};

void Frame::trace_tile_row(int tile_row) {
  for (int column = 0; column < intrinsics_.width_px; column += kTile_px)
    trace_tile(tile_row * kTile_px, column);
}

// Blocks of 4 x 2 pixels are neighbours in the batch: a packet of compact rays opens fewer nodes than a long
// row.
void Frame::trace_tile(int first_row, int first_column) {
  RayBatch rays;
  std::array<cv::Point, RayBatch::kCapacity> pixel;
  for (int i = 0; i < kTile_px * kTile_px; ++i) {
    const int block = i / 8;
    const cv::Point at(first_column + (block % 2) * 4 + i % 4, first_row + (block / 2) * 2 + (i % 8) / 4);
    if (at.x >= intrinsics_.width_px || at.y >= intrinsics_.height_px) continue;
    pixel[rays.count] = at;
    rays.add(origin_, direction(at.x, at.y), t_s_);
  }
  ShadedRays seen;
  shade(scene_, rays, pixel_rad_, seen);
  for (std::size_t i = 0; i < rays.count; ++i) {
    light_.at<cv::Vec3f>(pixel[i]) = {seen.light_rgb[i].x(), seen.light_rgb[i].y(), seen.light_rgb[i].z()};
    depth_m_.at<float>(pixel[i]) =
        seen.distance[i];  // directions have z = 1 in the camera: distance is plane depth
    key_.at<std::int32_t>(pixel[i]) = static_cast<std::int32_t>(seen.key[i]);
  }
}

bool Frame::is_edge(int row, int column) const {
  const std::int32_t mine = key_.at<std::int32_t>(row, column);
  return (column > 0 && key_.at<std::int32_t>(row, column - 1) != mine) ||
         (column + 1 < key_.cols && key_.at<std::int32_t>(row, column + 1) != mine) ||
         (row > 0 && key_.at<std::int32_t>(row - 1, column) != mine) ||
         (row + 1 < key_.rows && key_.at<std::int32_t>(row + 1, column) != mine);
}

void Frame::smooth_row(int row, int samples) {
  RayBatch rays;
  ShadedRays seen;
  std::array<int, RayBatch::kCapacity> column{};
  const int extras = samples - 1;  // the centre ray was traced before
  const auto per_pixel = static_cast<std::size_t>(extras);
  const auto flush = [&] {
    if (rays.count == 0) return;
    shade(scene_, rays, pixel_rad_, seen);
    for (std::size_t i = 0; i < rays.count; i += per_pixel) {
      auto& light = light_.at<cv::Vec3f>(row, column[i]);
      Vector3f sum(light[0], light[1], light[2]);
      for (std::size_t k = 0; k < per_pixel; ++k) sum += seen.light_rgb[i + k];
      sum /= static_cast<float>(samples);
      light = {sum.x(), sum.y(), sum.z()};
    }
    rays.count = 0;
  };
  for (int u = 0; u < intrinsics_.width_px; ++u) {
    if (!is_edge(row, u)) continue;
    if (rays.count + per_pixel > RayBatch::kCapacity) flush();
    column[rays.count] = u;
    for (int k = 0; k < extras; ++k) {
      const Eigen::Vector2d offset = sub_pixel(k, extras);
      rays.add(origin_, direction(u + offset.x(), row + offset.y()), t_s_);
    }
  }
  flush();
}

void Frame::encode_row(int row, float exposure, cv::Mat& image) const {
  static const std::array<std::uint8_t, kSrgbLevels> kTable = srgb_table();
  const auto encode = [&](float linear) {
    const float level = std::clamp(linear * exposure, 0.F, 1.F) * (kSrgbLevels - 1) + 0.5F;
    return kTable[static_cast<std::size_t>(level)];
  };
  for (int u = 0; u < image.cols; ++u) {
    const auto& rgb = light_.at<cv::Vec3f>(row, u);
    image.at<cv::Vec3b>(row, u) = {encode(rgb[2]), encode(rgb[1]), encode(rgb[0])};
  }
}

}  // namespace

void bind(Binder& b, RendererConfig& c) {
  b.field("exposure", c.exposure, "factor on the light; 1 puts sunlit grass near mid grey", positive());
  b.field("edge_samples", c.edge_samples, "rays per pixel at edges of objects and shadows; 1: no smoothing",
          between(1, 16));
  b.field("threads", c.threads, "0: as many as the machine has; the images do not depend on it",
          between(0, 256));
}

class Renderer::Impl {
 public:
  Impl(const World& world, const RendererConfig& renderer_config) : scene(world), config(renderer_config) {}

  /// @param times_s null: the start of the flight
  void cast(const Eigen::Vector3d* origins, const Eigen::Vector3d* directions, const double* times_s,
            std::size_t count, Hit* out) const;

  RayScene scene;
  RendererConfig config;
};

// At most a batch.
void Renderer::Impl::cast(const Eigen::Vector3d* origins, const Eigen::Vector3d* directions,
                          const double* times_s, std::size_t count, Hit* out) const {
  RayBatch rays;
  for (std::size_t i = 0; i < count; ++i) {
    rays.add(origins[i].cast<float>(), directions[i].normalized().cast<float>(),
             times_s != nullptr ? static_cast<float>(times_s[i]) : 0.F);
  }
  RayHits hits;
  scene.intersect(rays, false, hits);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = {};
    if (hits[i].distance <= 0) continue;
    const SurfacePoint point = scene.surface_point(hits[i], rays.origin(i), rays.direction(i));
    const Material material = point.surface->material;
    out[i] = {true, static_cast<double>(hits[i].distance), material, properties(material).lidar_reflectivity,
              point.facet_normal};
  }
}

Renderer::Renderer(const World& world, const RendererConfig& config)
    : impl_(std::make_unique<Impl>(world, config)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

const World& Renderer::world() const { return impl_->scene.world(); }

View Renderer::render_camera(const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_world_camera,
                             bool with_depth, double t_s) const {
  Frame frame(impl_->scene, intrinsics, T_world_camera, t_s);
  View view;
  view.image.create(intrinsics.size(), CV_8UC3);
  const RendererConfig& config = impl_->config;
  parallel_rows(config.threads, frame.tile_rows(), [&](int row) { frame.trace_tile_row(row); });
  parallel_rows(config.threads, intrinsics.height_px, [&](int row) {
    if (config.edge_samples > 1) frame.smooth_row(row, config.edge_samples);
    frame.encode_row(row, static_cast<float>(config.exposure), view.image);
  });
  if (with_depth) view.depth_m = frame.depth_m();
  return view;
}

Hit Renderer::cast(const Eigen::Vector3d& origin_world, const Eigen::Vector3d& direction_world,
                   double t_s) const {
  Hit hit;
  impl_->cast(&origin_world, &direction_world, &t_s, 1, &hit);
  return hit;
}

void Renderer::cast_many(const std::vector<Eigen::Vector3d>& origins_world,
                         const std::vector<Eigen::Vector3d>& directions_world, std::vector<Hit>& out,
                         const std::vector<double>& times_s) const {
  if (origins_world.size() != directions_world.size() ||
      (!times_s.empty() && times_s.size() != origins_world.size())) {
    throw std::invalid_argument(
        "Renderer::cast_many: as many origins as directions, and times if any, are needed");
  }
  out.resize(origins_world.size());
  for (std::size_t first = 0; first < out.size(); first += RayBatch::kCapacity) {
    const std::size_t count = std::min(RayBatch::kCapacity, out.size() - first);
    impl_->cast(&origins_world[first], &directions_world[first], times_s.empty() ? nullptr : &times_s[first],
                count, &out[first]);
  }
}

}  // namespace alight::sim
