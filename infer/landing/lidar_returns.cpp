#include "infer/landing/lidar_returns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "geometry/frames.hpp"

namespace alight {
namespace {

struct Point {
  std::int32_t column;  // from the camera's own cell
  std::int32_t row;
  float height_m;
};

/// std::floor, which without SSE4.1 is a call for every pixel.
std::int64_t floor_of(double x) {
  const auto i = static_cast<std::int64_t>(x);
  return x < static_cast<double>(i) ? i - 1 : i;
}

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
  const double limit = std::tan(to_radians(half_fov_deg));
  const std::int64_t column0 = floor_of(T_world_camera.translation().x() / cell_m);
  const std::int64_t row0 = floor_of(T_world_camera.translation().y() / cell_m);
  const std::int64_t reach = floor_of(reach_m / cell_m);
  std::vector<Point> points;
  points.reserve(sparse_m.total() / 4);
  cv::Point low(std::numeric_limits<int>::max(), std::numeric_limits<int>::max());
  cv::Point high(std::numeric_limits<int>::min(), std::numeric_limits<int>::min());
  std::vector<double> ray_x(static_cast<std::size_t>(sparse_m.cols));  // divided once, not in every row
  for (int u = 0; u < sparse_m.cols; ++u) ray_x[static_cast<std::size_t>(u)] = intrinsics.ray(u, 0).x();
  for (int v = 0; v < sparse_m.rows; ++v) {
    const double ray_y = intrinsics.ray(0, v).y();
    const auto* const depths = sparse_m.ptr<float>(v);
    for (int u = 0; u < sparse_m.cols; ++u) {
      const auto z_m = static_cast<double>(depths[u]);
      if (!(z_m > 0)) continue;
      const Eigen::Vector3d ray(ray_x[static_cast<std::size_t>(u)], ray_y, 1);
      out.within_fov += ray.head<2>().norm() < limit ? 1 : 0;
      const Eigen::Vector3d p = T_world_camera * Eigen::Vector3d(ray * z_m);
      const std::int64_t column = floor_of(p.x() / cell_m) - column0;
      const std::int64_t row = floor_of(p.y() / cell_m) - row0;
      if (std::abs(column) > reach || std::abs(row) > reach) continue;
      const cv::Point cell(static_cast<int>(column), static_cast<int>(row));
      points.push_back({cell.x, cell.y, static_cast<float>(p.z())});
      low = {std::min(low.x, cell.x), std::min(low.y, cell.y)};
      high = {std::max(high.x, cell.x), std::max(high.y, cell.y)};
    }
  }
  if (points.empty()) return out;
  out.first_column = column0 + low.x;
  out.first_row = row0 + low.y;
  const cv::Size size(high.x - low.x + 1, high.y - low.y + 1);
  for (cv::Mat* map : {&out.count, &out.mean_m, &out.top_m, &out.bottom_m})
    *map = cv::Mat::zeros(size, CV_32FC1);
  for (const Point& p : points) {
    const int row = p.row - low.y;
    const int column = p.column - low.x;
    float& count = out.count.at<float>(row, column);
    float& mean_m = out.mean_m.at<float>(row, column);
    float& top_m = out.top_m.at<float>(row, column);
    float& bottom_m = out.bottom_m.at<float>(row, column);
    top_m = count > 0 ? std::max(top_m, p.height_m) : p.height_m;
    bottom_m = count > 0 ? std::min(bottom_m, p.height_m) : p.height_m;
    count += 1;
    mean_m += (p.height_m - mean_m) / count;
  }
  return out;
}

}  // namespace alight
