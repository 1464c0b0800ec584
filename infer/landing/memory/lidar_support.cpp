#include "infer/landing/memory/lidar_support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "geometry/frames.hpp"
#include "geometry/wide_loops.hpp"

namespace alight {
namespace {

/// What the points of a row share on their way into the world.
struct ReturnRays {
  double ray_y;  // at unit depth
  double T_world_camera[3][4];
  double cell_m;
  double column0;  // the camera's own cell
  double row0;
  double reach;  // cells
};

constexpr std::int32_t kNowhere = std::numeric_limits<std::int32_t>::max();

/// Cells of points, counted from the camera's own, and their heights; column kNowhere where one lies out of reach.
/// @param ray_x at unit depth
ALIGHT_WIDE_LOOPS void cells_of_row(std::size_t count, const double* z, const double* ray_x,
                                    const ReturnRays& rays, std::int32_t* __restrict column,
                                    std::int32_t* __restrict row, float* __restrict height_m) {
  const auto& T = rays.T_world_camera;
  const double xx = T[0][0], xy = T[0][1], xz = T[0][2], x0 = T[0][3];
  const double yx = T[1][0], yy = T[1][1], yz = T[1][2], y0 = T[1][3];
  const double zx = T[2][0], zy = T[2][1], zz = T[2][2], z0 = T[2][3];
  const double cell_m = rays.cell_m, column0 = rays.column0, row0 = rays.row0, reach = rays.reach;
  const double ray_y = rays.ray_y;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = ray_x[i] * z[i];
    const double y = ray_y * z[i];
    const double c = std::floor((xx * x + xy * y + xz * z[i] + x0) / cell_m) - column0;
    const double r = std::floor((yx * x + yy * y + yz * z[i] + y0) / cell_m) - row0;
    const bool near = std::abs(c) <= reach && std::abs(r) <= reach;
    const auto near_column = static_cast<std::int32_t>(near ? c : 0.0);
    column[i] = near ? near_column : kNowhere;
    row[i] = static_cast<std::int32_t>(near ? r : 0.0);
    height_m[i] = static_cast<float>(zx * x + zy * y + zz * z[i] + z0);
  }
}

/// How many rays lie within `limit` of the optical axis, at unit depth.
ALIGHT_WIDE_LOOPS int count_within(std::size_t count, const double* ray_x, double ray_y, double limit) {
  int within = 0;
  for (std::size_t i = 0; i < count; ++i)
    within += std::sqrt(ray_x[i] * ray_x[i] + ray_y * ray_y) < limit ? 1 : 0;
  return within;
}

/// The points of a whole map as cells_of_row gives them.
struct CellPoints {
  std::vector<std::int32_t> columns;
  std::vector<std::int32_t> rows;
  std::vector<float> heights_m;
  double within_limit = 0;  // of the optical axis
};

/// @param rays what the rows share; its ray_y is set for each
/// @param limit off the optical axis, at unit depth
CellPoints points_of(const cv::Mat& sparse_m, const PinholeIntrinsics& intrinsics, ReturnRays rays,
                     double limit) {
  const int width = sparse_m.cols;
  Eigen::ArrayXd ray_x(width);
  for (int u = 0; u < width; ++u) ray_x[u] = intrinsics.ray(u, 0).x();
  CellPoints points;
  points.columns.reserve(sparse_m.total());
  points.rows.reserve(sparse_m.total());
  points.heights_m.reserve(sparse_m.total());
  Eigen::ArrayXd z(width + 1);
  Eigen::ArrayXd known_ray_x(width + 1);
  for (int v = 0; v < sparse_m.rows; ++v) {
    const auto* const depths_m = sparse_m.ptr<float>(v);
    std::size_t count = 0;  // of points, moved together
    for (int u = 0; u < width; ++u) {
      z[static_cast<Eigen::Index>(count)] = static_cast<double>(depths_m[u]);
      known_ray_x[static_cast<Eigen::Index>(count)] = ray_x[u];
      count += depths_m[u] > 0 ? 1 : 0;
    }
    const std::size_t at = points.columns.size();
    points.columns.resize(at + count);
    points.rows.resize(at + count);
    points.heights_m.resize(at + count);
    rays.ray_y = intrinsics.ray(0, v).y();
    cells_of_row(count, z.data(), known_ray_x.data(), rays, points.columns.data() + at,
                 points.rows.data() + at, points.heights_m.data() + at);
    points.within_limit += count_within(count, known_ray_x.data(), rays.ray_y, limit);
  }
  return points;
}

struct ReturnCell {
  float count = 0;
  float mean_m = 0;
  float top_m = 0;
  float bottom_m = 0;

  void add(float height_m) {
    top_m = count > 0 ? std::max(top_m, height_m) : height_m;
    bottom_m = count > 0 ? std::min(bottom_m, height_m) : height_m;
    count += 1;
    mean_m += (height_m - mean_m) / count;
  }
};

}  // namespace

bool LidarReturns::hit(std::int64_t world_column, std::int64_t world_row, int& column, int& row) const {
  const std::int64_t c = world_column - first_column;
  const std::int64_t r = world_row - first_row;
  if (c < 0 || r < 0 || c >= count.cols || r >= count.rows) return false;
  column = static_cast<int>(c);
  row = static_cast<int>(r);
  return count.at<float>(row, column) > 0;
}

LidarReturns lidar_returns(const cv::Mat& sparse_m, const PinholeIntrinsics& intrinsics,
                           const Eigen::Isometry3d& T_world_camera, double cell_m, double reach_m,
                           double half_fov_deg) {
  if (sparse_m.type() != CV_32FC1 || sparse_m.size() != intrinsics.size())
    throw std::invalid_argument("lidar_returns: the map must be CV_32FC1 of the camera's size");
  LidarReturns out;
  ReturnRays rays{};
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor>::Map(&rays.T_world_camera[0][0]) =
      T_world_camera.matrix().topRows<3>();
  rays.cell_m = cell_m;
  rays.column0 = std::floor(T_world_camera.translation().x() / cell_m);
  rays.row0 = std::floor(T_world_camera.translation().y() / cell_m);
  rays.reach = std::floor(reach_m / cell_m);
  const CellPoints points = points_of(sparse_m, intrinsics, rays, std::tan(to_radians(half_fov_deg)));
  out.within_fov = points.within_limit;
  const std::vector<std::int32_t>& columns = points.columns;
  const std::vector<std::int32_t>& rows = points.rows;
  cv::Point low(kNowhere, kNowhere);
  cv::Point high(std::numeric_limits<int>::min(), std::numeric_limits<int>::min());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i] == kNowhere) continue;
    low = {std::min(low.x, columns[i]), std::min(low.y, rows[i])};
    high = {std::max(high.x, columns[i]), std::max(high.y, rows[i])};
  }
  if (high.x < low.x) return out;
  out.first_column = static_cast<std::int64_t>(rays.column0) + low.x;
  out.first_row = static_cast<std::int64_t>(rays.row0) + low.y;
  const cv::Size size(high.x - low.x + 1, high.y - low.y + 1);
  std::vector<ReturnCell> cells(static_cast<std::size_t>(size.area()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i] == kNowhere) continue;
    cells[static_cast<std::size_t>((rows[i] - low.y) * size.width + columns[i] - low.x)].add(
        points.heights_m[i]);
  }
  for (cv::Mat* map : {&out.count, &out.mean_m, &out.top_m, &out.bottom_m}) map->create(size, CV_32FC1);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    out.count.ptr<float>()[i] = cells[i].count;
    out.mean_m.ptr<float>()[i] = cells[i].mean_m;
    out.top_m.ptr<float>()[i] = cells[i].top_m;
    out.bottom_m.ptr<float>()[i] = cells[i].bottom_m;
  }
  return out;
}

}  // namespace alight
