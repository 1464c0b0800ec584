#include "sim/truth/surface_truth.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "foundation/config_reader.hpp"
#include "foundation/parallel_rows.hpp"
#include "geometry/frames.hpp"

namespace alight::sim {
namespace {

constexpr double kSkyHeight_m = 500.0;  // the vertical rays start here, above everything that can be built

struct Offset {
  int row;
  int column;
  double x_m;
  double y_m;
};

// Cells of a disc; symmetric in both axes, so the plane fit's normal equations are diagonal.
std::vector<Offset> disc(double radius_m, double cell_m) {
  std::vector<Offset> offsets;
  const int reach = static_cast<int>(std::floor(radius_m / cell_m + 1e-9));
  for (int row = -reach; row <= reach; ++row) {
    for (int column = -reach; column <= reach; ++column) {
      if (std::hypot(row, column) * cell_m > radius_m + 1e-9) continue;
      offsets.push_back({row, column, column * cell_m, row * cell_m});
    }
  }
  return offsets;
}

struct Plane {
  double mean_m = 0;
  double slope_x = 0;
  double slope_y = 0;
};

Plane fit_plane(const cv::Mat& elevation_m, int row, int column, const std::vector<Offset>& offsets) {
  double sum = 0;
  double sum_xz = 0;
  double sum_yz = 0;
  double sum_xx = 0;
  // Heights relative to the centre: sums of large numbers would cost digits.
  const double centre_m = elevation_m.at<float>(row, column);
  for (const Offset& o : offsets) {
    const double z = elevation_m.at<float>(row + o.row, column + o.column) - centre_m;
    sum += z;
    sum_xz += o.x_m * z;
    sum_yz += o.y_m * z;
    sum_xx += o.x_m * o.x_m;
  }
  return {centre_m + sum / static_cast<double>(offsets.size()), sum_xz / sum_xx, sum_yz / sum_xx};
}

double largest_residual(const cv::Mat& elevation_m, int row, int column, const std::vector<Offset>& offsets,
                        const Plane& plane) {
  double largest = 0;
  for (const Offset& o : offsets) {
    const double expected = plane.mean_m + plane.slope_x * o.x_m + plane.slope_y * o.y_m;
    const double residual = std::abs(elevation_m.at<float>(row + o.row, column + o.column) - expected);
    if (!(residual <= largest)) largest = residual;  // NaN, where nothing was hit, wins and stays
    if (std::isnan(largest)) break;
  }
  return largest;
}

}  // namespace

void bind(Binder& b, SurfaceTruthConfig& c) {
  b.field("cell_m", c.cell_m, "side of a cell of the elevation grid", between(0.02, 2));
  b.field("radius_m", c.radius_m, "of the disc on which a cell's plane is fitted", between(0.02, 5));
  b.field("max_slope_deg", c.max_slope_deg, "steepest safe plane", between(0, 90));
  b.field("max_residual_m", c.max_residual_m, "largest safe distance to the plane", at_least(0));
  b.field("surface_tolerance_m", c.surface_tolerance_m,
          "height within which a pixel shows a cell's top surface", positive());
  b.check("radius_m", c.radius_m >= c.cell_m, "must be at least cell_m, or no plane can be fitted");
}

SurfaceTruth::SurfaceTruth(const Renderer& renderer, const SurfaceTruthConfig& config, double t_s)
    : config_(config), min_m_(-0.5 * renderer.world().size_m()) {
  if (config.cell_m <= 0 || config.radius_m < config.cell_m) {
    throw std::invalid_argument("SurfaceTruth: radius_m must be at least cell_m, cell_m positive");
  }
  measure_elevation(renderer, t_s);
  fit_planes();
  // Safe cells touching the grid's border: what lies beyond is not known to be safe.
  cv::Mat framed;
  cv::copyMakeBorder(safe_, framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat distance_cells;
  cv::distanceTransform(framed, distance_cells, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  // From the centre of a cell to the edge, not the centre, of the nearest unsafe cell.
  cv::Mat inner = distance_cells(cv::Rect(1, 1, safe_.cols, safe_.rows));
  clearance_m_ = cv::max((inner - 0.5) * config_.cell_m, 0.0);
}

void SurfaceTruth::measure_elevation(const Renderer& renderer, double t_s) {
  const int cells = static_cast<int>(std::floor(renderer.world().size_m() / config_.cell_m + 1e-9));
  elevation_m_.create(cells, cells, CV_32FC1);
  landable_.create(cells, cells, CV_8UC1);
  const auto count = static_cast<std::size_t>(cells);
  const std::vector<Eigen::Vector3d> down(count, -Eigen::Vector3d::UnitZ());
  const std::vector<double> times_s(count, t_s);
  parallel_rows(0, cells, [&](int row) {
    std::vector<Eigen::Vector3d> origins(count);
    std::vector<Hit> hits;
    for (int column = 0; column < cells; ++column) {
      origins[static_cast<std::size_t>(column)] = {min_m_ + (column + 0.5) * config_.cell_m,
                                                   min_m_ + (row + 0.5) * config_.cell_m, kSkyHeight_m};
    }
    renderer.cast_many(origins, down, hits, times_s);
    for (int column = 0; column < cells; ++column) {
      const Hit& hit = hits[static_cast<std::size_t>(column)];
      elevation_m_.at<float>(row, column) =
          hit.hit ? static_cast<float>(kSkyHeight_m - hit.range_m) : std::numeric_limits<float>::quiet_NaN();
      landable_.at<std::uint8_t>(row, column) = hit.hit && properties(hit.material).landable ? 255 : 0;
    }
  });
}

void SurfaceTruth::fit_planes() {
  const std::vector<Offset> offsets = disc(config_.radius_m, config_.cell_m);
  const int reach = static_cast<int>(std::floor(config_.radius_m / config_.cell_m + 1e-9));
  const double max_gradient = std::tan(to_radians(config_.max_slope_deg));
  cv::Mat ground;  // every cell of the disc is landable
  cv::Mat kernel = cv::Mat::zeros(2 * reach + 1, 2 * reach + 1, CV_8UC1);
  for (const Offset& o : offsets) kernel.at<std::uint8_t>(o.row + reach, o.column + reach) = 1;
  cv::erode(landable_, ground, kernel, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  const cv::Scalar unknown(std::numeric_limits<double>::quiet_NaN());
  slope_rad_ = cv::Mat(elevation_m_.size(), CV_32FC1, unknown);
  residual_m_ = cv::Mat(elevation_m_.size(), CV_32FC1, unknown);
  safe_ = cv::Mat::zeros(elevation_m_.size(), CV_8UC1);
  parallel_rows(0, elevation_m_.rows - 2 * reach, [&](int inner_row) {
    const int row = inner_row + reach;
    for (int column = reach; column < elevation_m_.cols - reach; ++column) {
      const Plane plane = fit_plane(elevation_m_, row, column, offsets);
      const double gradient = std::hypot(plane.slope_x, plane.slope_y);
      const double residual_m = largest_residual(elevation_m_, row, column, offsets, plane);
      slope_rad_.at<float>(row, column) = static_cast<float>(std::atan(gradient));
      residual_m_.at<float>(row, column) = static_cast<float>(residual_m);
      const bool flat = gradient < max_gradient && residual_m < config_.max_residual_m;
      safe_.at<std::uint8_t>(row, column) = flat && ground.at<std::uint8_t>(row, column) != 0 ? 255 : 0;
    }
  });
}

bool SurfaceTruth::cell_at(double x_m, double y_m, int& row, int& column) const {
  const double c = std::floor((x_m - min_m_) / config_.cell_m);
  const double r = std::floor((y_m - min_m_) / config_.cell_m);
  if (!(c >= 0 && r >= 0 && c < elevation_m_.cols && r < elevation_m_.rows)) return false;
  row = static_cast<int>(r);
  column = static_cast<int>(c);
  return true;
}

std::optional<GroundCell> SurfaceTruth::ground_at(double x_m, double y_m) const {
  int row = 0;
  int column = 0;
  if (!cell_at(x_m, y_m, row, column)) return std::nullopt;
  GroundCell cell;
  cell.elevation_m = elevation_m_.at<float>(row, column);
  cell.slope_rad = slope_rad_.at<float>(row, column);
  cell.residual_m = residual_m_.at<float>(row, column);
  cell.landable = landable_.at<std::uint8_t>(row, column) != 0;
  cell.safe = safe_.at<std::uint8_t>(row, column) != 0;
  return cell;
}

bool SurfaceTruth::is_safe(double x_m, double y_m) const {
  int row = 0;
  int column = 0;
  return cell_at(x_m, y_m, row, column) && safe_.at<std::uint8_t>(row, column) != 0;
}

double SurfaceTruth::clearance_m(double x_m, double y_m) const {
  int row = 0;
  int column = 0;
  return cell_at(x_m, y_m, row, column) ? clearance_m_.at<float>(row, column) : 0.0;
}

double SurfaceTruth::elevation_m(double x_m, double y_m) const {
  int row = 0;
  int column = 0;
  if (!cell_at(x_m, y_m, row, column)) return std::numeric_limits<double>::quiet_NaN();
  return elevation_m_.at<float>(row, column);
}

SafeCircle SurfaceTruth::largest_safe_circle(double half_width_m) const {
  SafeCircle best;
  for (int row = 0; row < safe_.rows; ++row) {
    for (int column = 0; column < safe_.cols; ++column) {
      const double x_m = min_m_ + (column + 0.5) * config_.cell_m;
      const double y_m = min_m_ + (row + 0.5) * config_.cell_m;
      if (std::abs(x_m) > half_width_m || std::abs(y_m) > half_width_m) continue;
      const double radius_m = clearance_m_.at<float>(row, column);
      if (radius_m <= best.radius_m) continue;
      best = {{x_m, y_m, elevation_m_.at<float>(row, column)}, radius_m};
    }
  }
  return best;
}

cv::Mat SurfaceTruth::safe_mask(const cv::Mat& depth_m, const PinholeIntrinsics& intrinsics,
                                const Eigen::Isometry3d& T_world_camera) const {
  if (depth_m.type() != CV_32FC1 || depth_m.size() != intrinsics.size()) {
    throw std::invalid_argument("SurfaceTruth::safe_mask: depth must be CV_32FC1 of the intrinsics' size");
  }
  cv::Mat mask = cv::Mat::zeros(depth_m.size(), CV_8UC1);
  parallel_rows(0, depth_m.rows, [&](int v) {
    for (int u = 0; u < depth_m.cols; ++u) {
      const double z_m = depth_m.at<float>(v, u);
      if (!(z_m > 0)) continue;
      const Eigen::Vector3d p_world = T_world_camera * Eigen::Vector3d(intrinsics.ray(u, v) * z_m);
      int row = 0;
      int column = 0;
      if (!cell_at(p_world.x(), p_world.y(), row, column) || safe_.at<std::uint8_t>(row, column) == 0)
        continue;
      const double height_m = p_world.z() - elevation_m_.at<float>(row, column);
      if (std::abs(height_m) < config_.surface_tolerance_m) mask.at<std::uint8_t>(v, u) = 255;
    }
  });
  return mask;
}

}  // namespace alight::sim
