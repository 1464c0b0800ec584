#include "infer/landing/ground/elevation_raster.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "geometry/wide_loops.hpp"

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
  float low_east_m = 0;
  float low_north_m = 0;
  float high_east_m = 0;
  float high_north_m = 0;
};

/// What turns a row of depths into points: pixel u looks along first + u * step.
struct RowRays {
  float first[3];
  float step[3];
  float camera_m[3];  // from the corner of the camera's cell; z: the world's
  float reach_m;
};

ALIGHT_WIDE_LOOPS void points_of_row(int width, const float* z, const RowRays& rays, float* __restrict east,
                                     float* __restrict north, float* __restrict up) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const float x0 = rays.first[0], y0 = rays.first[1], z0 = rays.first[2];
  const float dx = rays.step[0], dy = rays.step[1], dz = rays.step[2];
  const float camera_x = rays.camera_m[0], camera_y = rays.camera_m[1], camera_z = rays.camera_m[2];
  const float reach = rays.reach_m;
  for (int u = 0; u < width; ++u) {
    const auto column = static_cast<float>(u);
    const float down = z0 + column * dz;
    const float x = z[u] * (x0 + column * dx);
    const float y = z[u] * (y0 + column * dy);
    const bool good = z[u] > 0 && down < -kFlattestRay && std::abs(x) < reach && std::abs(y) < reach;
    east[u] = good ? x + camera_x : kNone;
    north[u] = good ? y + camera_y : kNone;
    up[u] = camera_z + z[u] * down;
  }
}

/// The least and the greatest coordinate of every column of the image so far.
ALIGHT_WIDE_LOOPS void extend(int width, const float* coordinate_m, float* __restrict low_m,
                              float* __restrict high_m) {
  for (int u = 0; u < width; ++u) {  // a comparison with NaN leaves the limit as it is
    low_m[u] = coordinate_m[u] < low_m[u] ? coordinate_m[u] : low_m[u];
    high_m[u] = coordinate_m[u] > high_m[u] ? coordinate_m[u] : high_m[u];
  }
}

/// @param corner_m from the corner of the camera's cell to the camera
Points points_of(const cv::Mat& depth_m, const PinholeIntrinsics& k, const Eigen::Isometry3d& T_world_camera,
                 const Eigen::Vector2d& corner_m, double reach_m) {
  Points points(depth_m.total());
  const Eigen::Matrix3f R = T_world_camera.linear().cast<float>();
  RowRays rays;
  Eigen::Vector3f::Map(rays.step) = R.col(0) / static_cast<float>(k.fx_px);
  Eigen::Vector3f::Map(rays.camera_m) << corner_m.cast<float>(),
      static_cast<float>(T_world_camera.translation().z());
  rays.reach_m = static_cast<float>(reach_m);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const int width = depth_m.cols;
  Eigen::ArrayXf low_east_m = Eigen::ArrayXf::Constant(width, kInfinity);
  Eigen::ArrayXf low_north_m = low_east_m;
  Eigen::ArrayXf high_east_m = -low_east_m;
  Eigen::ArrayXf high_north_m = -low_east_m;
  std::size_t at = 0;
  for (int v = 0; v < depth_m.rows; ++v, at += static_cast<std::size_t>(width)) {
    Eigen::Vector3f::Map(rays.first) = R * k.ray(0, v).cast<float>();
    points_of_row(width, depth_m.ptr<float>(v), rays, &points.east_m[at], &points.north_m[at],
                  &points.height_m[at]);
    extend(width, &points.east_m[at], low_east_m.data(), high_east_m.data());
    extend(width, &points.north_m[at], low_north_m.data(), high_north_m.data());
  }
  points.low_east_m = low_east_m.minCoeff();
  points.low_north_m = low_north_m.minCoeff();
  points.high_east_m = high_east_m.maxCoeff();
  points.high_north_m = high_north_m.maxCoeff();
  return points;
}

/// How high and how low the surface surely is around each of `count` points.
/// @param sums, counts of the known heights in its window
ALIGHT_WIDE_LOOPS void bounds_of(std::size_t count, const float* height_m, const float* sums,
                                 const float* counts, float single_m, float* __restrict top_m,
                                 float* __restrict bottom_m) {
  for (std::size_t i = 0; i < count; ++i) {
    const float n = counts[i] < 1.F ? 1.F : counts[i];
    const float mean_m = sums[i] / n;
    const float window_m = single_m / std::sqrt(n);
    const float single_top_m = height_m[i] - single_m, window_top_m = mean_m - window_m;
    const float single_bottom_m = height_m[i] + single_m, window_bottom_m = mean_m + window_m;
    top_m[i] = single_top_m < window_top_m ? window_top_m : single_top_m;
    bottom_m[i] = window_bottom_m < single_bottom_m ? window_bottom_m : single_bottom_m;
  }
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
  bounds_of(points.height_m.size(), points.height_m.data(), sum.ptr<float>(), count.ptr<float>(),
            kNoiseSigmas * noise_m, points.top_m.data(), points.bottom_m.data());
}

struct Cell {
  float sum_m = 0;
  float east_m = 0;
  float north_m = 0;
  float count = 0;
  float top_m = -std::numeric_limits<float>::infinity();
  float bottom_m = std::numeric_limits<float>::infinity();
};

/// Numbers of the cells in which coordinates lie; of NaN: any. Without std::floor, which before SSE4.1 is a call.
ALIGHT_WIDE_LOOPS void cells_of(int count, const float* coordinate_m, float per_m, int* __restrict cell) {
  for (int i = 0; i < count; ++i) {
    const float place = coordinate_m[i] * per_m;
    const float known = place == place ? place : 0.F;
    const int towards_zero = static_cast<int>(known);
    cell[i] = towards_zero - (static_cast<float>(towards_zero) > known ? 1 : 0);
  }
}

int cell_of(float coordinate_m, float per_m) {
  int cell = 0;
  cells_of(1, &coordinate_m, per_m, &cell);
  return cell;
}

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
  constexpr std::size_t kBlock = 512;  // stays in the nearest cache
  std::array<int, kBlock> columns{};
  std::array<int, kBlock> rows{};
  for (std::size_t begin = 0; begin < points.east_m.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, points.east_m.size() - begin);
    cells_of(static_cast<int>(count), &points.east_m[begin], per_m, columns.data());
    cells_of(static_cast<int>(count), &points.north_m[begin], per_m, rows.data());
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = begin + k;
      if (std::isnan(points.east_m[i])) continue;
      Cell& cell = out.cells[static_cast<std::size_t>((rows[k] - out.row0) * out.size.width + columns[k] -
                                                      out.column0)];
      cell.sum_m += points.height_m[i];
      cell.east_m += points.east_m[i];
      cell.north_m += points.north_m[i];
      cell.count += 1;
      cell.top_m = std::max(cell.top_m, tops_m[i]);
      cell.bottom_m = std::min(cell.bottom_m, bottoms_m[i]);
    }
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
