#include "infer/landing/elevation_raster.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace alight {
namespace {

constexpr float kFlattestRay = 0.1F;  // rays that hardly go down say little about the ground
/// So many sigma of noise say nothing about the ground; with 0.07 m of tolerance a noise of 2 cm then has 6 sigma.
constexpr float kNoiseSigmas = 2.5F;
constexpr double kWindow_m = 0.2;  // side of the square over which heights are averaged against noise

/// Points as separate arrays: one pass computes them in vector instructions, the next one sorts them into cells.
struct Points {
  explicit Points(std::size_t count) : east_m(count), north_m(count), height_m(count) {}
  std::vector<float> east_m;    // from the corner of the camera's cell; NaN: none
  std::vector<float> north_m;   // likewise
  std::vector<float> height_m;  // the world's z
  std::vector<float> top_m;     // how high the surface surely is; empty: height_m, there is no noise
  std::vector<float> bottom_m;  // and how low
  float low_east_m = std::numeric_limits<float>::infinity();
  float low_north_m = low_east_m;
  float high_east_m = -low_east_m;
  float high_north_m = -low_east_m;
};

/// @param corner_m from the corner of the camera's cell to the camera
Points points_of(const cv::Mat& depth_m, const PinholeIntrinsics& k, const Eigen::Isometry3d& T_world_camera,
                 const Eigen::Vector2d& corner_m, double reach_m) {
  Points points(depth_m.total());
  const Eigen::Matrix3f R = T_world_camera.linear().cast<float>();
  const Eigen::Vector3f step = R.col(0) / static_cast<float>(k.fx_px);
  const auto height_m = static_cast<float>(T_world_camera.translation().z());
  const auto corner_east_m = static_cast<float>(corner_m.x());
  const auto corner_north_m = static_cast<float>(corner_m.y());
  const auto reach = static_cast<float>(reach_m);
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  float* east = points.east_m.data();
  float* north = points.north_m.data();
  float* up = points.height_m.data();
  for (int v = 0; v < depth_m.rows; ++v) {
    const Eigen::Vector3f first = R * k.ray(0, v).cast<float>();
    const float* z = depth_m.ptr<float>(v);
    for (int u = 0; u < depth_m.cols; ++u) {
      const auto column = static_cast<float>(u);
      const float down = first.z() + column * step.z();
      const float x = z[u] * (first.x() + column * step.x());
      const float y = z[u] * (first.y() + column * step.y());
      const bool good = z[u] > 0 && down < -kFlattestRay && std::abs(x) < reach && std::abs(y) < reach;
      east[u] = good ? x + corner_east_m : kNone;
      north[u] = good ? y + corner_north_m : kNone;
      up[u] = height_m + z[u] * down;
    }
    for (int u = 0; u < depth_m.cols; ++u) {  // a comparison with NaN leaves the limit as it is
      points.low_east_m = east[u] < points.low_east_m ? east[u] : points.low_east_m;
      points.high_east_m = east[u] > points.high_east_m ? east[u] : points.high_east_m;
      points.low_north_m = north[u] < points.low_north_m ? north[u] : points.low_north_m;
      points.high_north_m = north[u] > points.high_north_m ? north[u] : points.high_north_m;
    }
    east += depth_m.cols;
    north += depth_m.cols;
    up += depth_m.cols;
  }
  return points;
}

/// Noise of one point is known to its sigma, that of a window's mean to sigma / sqrt(n): what is wide is told from noise by
/// the mean, at any place relative to the cells; what is thin, by its single points.
void bound(const cv::Size& size, double window_px, float noise_m, Points& points) {
  cv::Mat height(size, CV_32FC1, points.height_m.data());
  cv::Mat known(size, CV_32FC1);
  std::transform(points.east_m.begin(), points.east_m.end(), known.ptr<float>(),
                 [](float east) { return std::isnan(east) ? 0.F : 1.F; });
  const int side = std::max(3, 2 * static_cast<int>(window_px / 2) + 1);
  cv::Mat sum;
  cv::Mat count;
  const auto add_up = [&](const cv::Mat& from, cv::Mat& to) {
    cv::boxFilter(from, to, CV_32F, {side, side}, {-1, -1}, false, cv::BORDER_CONSTANT);
  };
  add_up(height.mul(known), sum);
  add_up(known, count);
  points.top_m.resize(points.height_m.size());
  points.bottom_m.resize(points.height_m.size());
  const auto* const sums = sum.ptr<float>();
  const auto* const counts = count.ptr<float>();
  const float single_m = kNoiseSigmas * noise_m;
  for (std::size_t i = 0; i < points.height_m.size(); ++i) {
    const float n = std::max(counts[i], 1.F);
    const float mean_m = sums[i] / n;
    const float window_m = single_m / std::sqrt(n);
    points.top_m[i] = std::max(points.height_m[i] - single_m, mean_m - window_m);
    points.bottom_m[i] = std::min(points.height_m[i] + single_m, mean_m + window_m);
  }
}

struct Cell {
  float sum_m = 0;
  float east_m = 0;
  float north_m = 0;
  float count = 0;
  float top_m = -std::numeric_limits<float>::infinity();
  float bottom_m = std::numeric_limits<float>::infinity();
};

int cell_of(float coordinate_m, float per_m) { return static_cast<int>(std::floor(coordinate_m * per_m)); }

/// The points of every cell, and where the cells lie from the camera's.
struct Cells {
  int column0 = 0;
  int row0 = 0;
  cv::Size size;
  std::vector<Cell> cells;  // row by row
};

Cells sort_into_cells(const Points& points, double cell_m) {
  const std::vector<float>& tops_m = points.top_m.empty() ? points.height_m : points.top_m;
  const std::vector<float>& bottoms_m = points.bottom_m.empty() ? points.height_m : points.bottom_m;
  const auto per_m = static_cast<float>(1 / cell_m);
  Cells out;
  out.column0 = cell_of(points.low_east_m, per_m);
  out.row0 = cell_of(points.low_north_m, per_m);
  out.size = {cell_of(points.high_east_m, per_m) - out.column0 + 1,
              cell_of(points.high_north_m, per_m) - out.row0 + 1};
  out.cells.resize(static_cast<std::size_t>(out.size.area()));
  for (std::size_t i = 0; i < points.east_m.size(); ++i) {
    if (std::isnan(points.east_m[i])) continue;
    const int column = cell_of(points.east_m[i], per_m) - out.column0;
    const int row = cell_of(points.north_m[i], per_m) - out.row0;
    Cell& cell = out.cells[static_cast<std::size_t>(row * out.size.width + column)];
    cell.sum_m += points.height_m[i];
    cell.east_m += points.east_m[i];
    cell.north_m += points.north_m[i];
    cell.count += 1;
    cell.top_m = std::max(cell.top_m, tops_m[i]);
    cell.bottom_m = std::min(cell.bottom_m, bottoms_m[i]);
  }
  return out;
}

void write_maps(const Cells& cells, float side_m, ElevationRaster& raster) {
  raster.mean_m.create(cells.size, CV_32FC1);
  raster.top_m.create(cells.size, CV_32FC1);
  raster.bottom_m.create(cells.size, CV_32FC1);
  raster.east_m.create(cells.size, CV_32FC1);
  raster.north_m.create(cells.size, CV_32FC1);
  raster.known.create(cells.size, CV_8UC1);
  const Cell* cell = cells.cells.data();
  for (int row = 0; row < cells.size.height; ++row) {
    for (int column = 0; column < cells.size.width; ++column, ++cell) {
      const bool known = cell->count > 0;
      const float mean_m = known ? cell->sum_m / cell->count : 0.F;
      raster.mean_m.at<float>(row, column) = mean_m;
      raster.top_m.at<float>(row, column) = known ? std::max(cell->top_m, mean_m) : 0.F;
      raster.bottom_m.at<float>(row, column) = known ? std::min(cell->bottom_m, mean_m) : 0.F;
      const float middle_east_m = side_m * (static_cast<float>(cells.column0 + column) + 0.5F);
      const float middle_north_m = side_m * (static_cast<float>(cells.row0 + row) + 0.5F);
      raster.east_m.at<float>(row, column) = known ? cell->east_m / cell->count - middle_east_m : 0.F;
      raster.north_m.at<float>(row, column) = known ? cell->north_m / cell->count - middle_north_m : 0.F;
      raster.known.at<std::uint8_t>(row, column) = known ? 255 : 0;
    }
  }
}

}  // namespace

bool ElevationRaster::cell_at(double x_m, double y_m, int& column, int& row) const {
  const double c = std::floor(x_m / cell_m) - static_cast<double>(first_column);
  const double r = std::floor(y_m / cell_m) - static_cast<double>(first_row);
  if (!(c >= 0 && r >= 0 && c < known.cols && r < known.rows)) return false;
  column = static_cast<int>(c);
  row = static_cast<int>(r);
  return true;
}

ElevationRaster rasterize(const cv::Mat& depth_m, const PinholeIntrinsics& intrinsics,
                          const Eigen::Isometry3d& T_world_camera, double cell_m, double reach_m,
                          double noise_m) {
  if (depth_m.type() != CV_32FC1 || depth_m.size() != intrinsics.size()) {
    throw std::invalid_argument("rasterize: depth must be CV_32FC1 of the camera's size");
  }
  if (!(cell_m > 0 && reach_m > 0)) throw std::invalid_argument("rasterize: cell and reach must be positive");
  const Eigen::Vector2d camera_m = T_world_camera.translation().head<2>();
  const Eigen::Vector2d camera_cell = (camera_m / cell_m).array().floor();
  Points points = points_of(depth_m, intrinsics, T_world_camera, camera_m - camera_cell * cell_m, reach_m);
  ElevationRaster raster;
  raster.cell_m = cell_m;
  if (points.high_east_m < points.low_east_m) return raster;
  if (noise_m > 0) {
    const double px_per_m = std::min(intrinsics.fx_px, intrinsics.fy_px) / cv::mean(depth_m, depth_m > 0)[0];
    bound(depth_m.size(), kWindow_m * px_per_m, static_cast<float>(noise_m), points);
  }
  const Cells cells = sort_into_cells(points, cell_m);
  raster.first_column = static_cast<std::int64_t>(camera_cell.x()) + cells.column0;
  raster.first_row = static_cast<std::int64_t>(camera_cell.y()) + cells.row0;
  write_maps(cells, static_cast<float>(cell_m), raster);
  return raster;
}

}  // namespace alight
