#include "infer/landing/planes/shown_ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "geometry/wide_loops.hpp"

namespace alight {
namespace {

/// What a pixel shows of its cell; nothing of an unknown one, no circle on an unsafe one.
struct ShownCell {
  float slope_rad = 0;
  float residual_m = 0;
  float radius_m = 0;
  std::uint8_t known = 0;
  std::uint8_t safe = 0;
};

/// Row by row.
std::vector<ShownCell> shown_cells(const GroundMap& ground) {
  const cv::Size size = ground.raster.size();
  std::vector<ShownCell> cells(static_cast<std::size_t>(size.area()));
  auto cell = cells.begin();
  for (int row = 0; row < size.height; ++row) {
    const auto* const known = ground.shape.known.ptr<std::uint8_t>(row);
    const auto* const safe = ground.safe.ptr<std::uint8_t>(row);
    const auto* const gradient = ground.shape.gradient.ptr<float>(row);
    const auto* const residual_m = ground.shape.residual_m.ptr<float>(row);
    const auto* const radius_m = ground.radius_m.ptr<float>(row);
    for (int column = 0; column < size.width; ++column, ++cell) {
      if (known[column] == 0) continue;
      *cell = {std::atan(gradient[column]), residual_m[column], 0, 255, 0};
      if (safe[column] == 0) continue;
      cell->safe = 255;
      cell->radius_m = radius_m[column];
    }
  }
  return cells;
}

/// Of the pixels of a row.
struct RowCells {
  explicit RowCells(int width) : cell(width), off_centre_m(width) {}
  Eigen::ArrayXi cell;  // number of the cell, row by row; -1: none
  Eigen::ArrayXf off_centre_m;
};

/// @param camera, first, step in cells: pixel u of depth z lies at camera + z * (first + u * step)
ALIGHT_WIDE_LOOPS void find_cells(int width, const float* z, const float (&camera)[2],
                                  const float (&first)[2], const float (&step)[2], const cv::Size& size,
                                  float cell_m, int* __restrict cell, float* __restrict off_centre_m) {
  const float camera_x = camera[0], camera_y = camera[1], x0 = first[0], y0 = first[1];
  const float step_x = step[0], step_y = step[1];
  const int columns = size.width;
  const auto right = static_cast<float>(size.width);
  const auto top = static_cast<float>(size.height);
  for (int u = 0; u < width; ++u) {
    const float x = camera_x + z[u] * (x0 + static_cast<float>(u) * step_x);
    const float y = camera_y + z[u] * (y0 + static_cast<float>(u) * step_y);
    const bool inside = z[u] > 0 && x >= 0 && y >= 0 && x < right && y < top;
    const int column = static_cast<int>(inside ? x : 0.F);
    const int row = static_cast<int>(inside ? y : 0.F);
    cell[u] = inside ? row * columns + column : -1;
    const float dx = x - static_cast<float>(column) - 0.5F;
    const float dy = y - static_cast<float>(row) - 0.5F;
    off_centre_m[u] = cell_m * std::sqrt(dx * dx + dy * dy);
  }
}

}  // namespace

void show_ground(const PinholeIntrinsics& intrinsics, const Eigen::Isometry3d& T_world_level, double margin_m,
                 SiteSelection& out) {
  const cv::Size size = intrinsics.size();
  out.terrain.slope_rad = cv::Mat::zeros(size, CV_32FC1);
  out.terrain.residual_m = cv::Mat::zeros(size, CV_32FC1);
  out.terrain.known = cv::Mat::zeros(size, CV_8UC1);
  out.safe = cv::Mat::zeros(size, CV_8UC1);
  out.radius_m = cv::Mat::zeros(size, CV_32FC1);
  if (out.ground.empty()) return;
  const ElevationRaster& raster = out.ground.raster;
  const std::vector<ShownCell> cells = shown_cells(out.ground);
  // In cells, from the raster's corner; the level camera's optical axis has no horizontal part.
  const double per_m = 1 / raster.cell_m;
  const Eigen::Vector2d corner(static_cast<double>(raster.first_column),
                               static_cast<double>(raster.first_row));
  const Eigen::Vector2f camera = (T_world_level.translation().head<2>() * per_m - corner).cast<float>();
  const Eigen::Matrix2f turn = (T_world_level.linear().topLeftCorner<2, 2>() * per_m).cast<float>();
  const auto off_radius_m = static_cast<float>(margin_m);
  RowCells row(size.width);
  for (int v = 0; v < size.height; ++v) {
    const Eigen::Vector2f first = turn * intrinsics.ray(0, v).head<2>().cast<float>();
    const Eigen::Vector2f step = turn.col(0) / static_cast<float>(intrinsics.fx_px);
    find_cells(size.width, out.level_depth_m.ptr<float>(v), {camera.x(), camera.y()}, {first.x(), first.y()},
               {step.x(), step.y()}, raster.size(), static_cast<float>(raster.cell_m), row.cell.data(),
               row.off_centre_m.data());
    auto* const known = out.terrain.known.ptr<std::uint8_t>(v);
    auto* const slope_rad = out.terrain.slope_rad.ptr<float>(v);
    auto* const residual_m = out.terrain.residual_m.ptr<float>(v);
    auto* const safe = out.safe.ptr<std::uint8_t>(v);
    auto* const radius_m = out.radius_m.ptr<float>(v);
    for (int u = 0; u < size.width; ++u) {
      if (row.cell[u] < 0) continue;
      const ShownCell& cell = cells[static_cast<std::size_t>(row.cell[u])];
      known[u] = cell.known;
      slope_rad[u] = cell.slope_rad;
      residual_m[u] = cell.residual_m;
      safe[u] = cell.safe;
      // The circle around the pixel lies in the one around the cell's centre.
      radius_m[u] = std::max(cell.radius_m - row.off_centre_m[u] - off_radius_m, 0.F);
    }
  }
}

}  // namespace alight
