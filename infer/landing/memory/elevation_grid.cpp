#include "infer/landing/memory/elevation_grid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"

namespace alight {

void bind(Binder& b, ElevationGridConfig& c) {
  b.field("cell_m", c.cell_m, "side of a cell", between(0.05, 2));
  b.field("size_m", c.size_m, "side of the window that moves with the vehicle", between(10, 1000));
  b.check("size_m", c.size_m <= 1000 * c.cell_m, "must be at most 1000 cells");
  b.field("obstacle_m", c.obstacle_m, "what differs more from a frame's plane is remembered at one sight",
          between(0.02, 5));
  b.field("moved_m", c.moved_m, "ground that differs more from the remembered one has moved",
          between(0.02, 10));
  b.field("forget_after_s", c.forget_after_s,
          "an obstacle is forgotten where its place is seen without it, but not sooner", between(0, 3600));
  b.field("max_count", c.max_count, "frames that a mean counts at most", between(1, 10000));
  b.field("max_height_offset_m", c.max_height_offset_m,
          "frames that differ more in height from the grid start it anew", between(0.1, 100));
  b.field("lidar_half_fov_deg", c.lidar_half_fov_deg, "around the optical axis, where LiDAR returns are due",
          between(1, 80));
  b.field("min_expected_returns", c.min_expected_returns,
          "ground without any return where so many a cell were due is a hazard; 0: off", between(0, 10000));
}

ElevationGrid::ElevationGrid(const ElevationGridConfig& config)
    : config_(config),
      side_(static_cast<std::int64_t>(std::ceil(config.size_m / config.cell_m))),
      column_slots_(static_cast<std::size_t>(side_)),
      row_slots_(static_cast<std::size_t>(side_)),
      cells_(static_cast<std::size_t>(side_ * side_)) {}

bool ElevationGrid::inside(std::int64_t column, std::int64_t row) const {
  return column >= first_column_ && row >= first_row_ && column < first_column_ + side_ &&
         row < first_row_ + side_;
}

ElevationCell& ElevationGrid::at(std::int64_t column, std::int64_t row) {
  return cells_[row_slots_[static_cast<std::size_t>(row - first_row_)] +
                column_slots_[static_cast<std::size_t>(column - first_column_)]];
}
const ElevationCell& ElevationGrid::at(std::int64_t column, std::int64_t row) const {
  return const_cast<ElevationGrid*>(this)->at(column, row);
}

const ElevationCell* ElevationGrid::cell(double east_m, double north_m) const {
  const auto column = static_cast<std::int64_t>(std::floor(east_m / config_.cell_m));
  const auto row = static_cast<std::int64_t>(std::floor(north_m / config_.cell_m));
  return started_ && inside(column, row) ? &at(column, row) : nullptr;
}

/// Moves the window; what enters it anew takes the slots of what leaves it.
void ElevationGrid::recentre(const Eigen::Vector3d& p_world_camera) {
  const std::int64_t column =
      static_cast<std::int64_t>(std::floor(p_world_camera.x() / config_.cell_m)) - side_ / 2;
  const std::int64_t row =
      static_cast<std::int64_t>(std::floor(p_world_camera.y() / config_.cell_m)) - side_ / 2;
  if (started_ && column == first_column_ && row == first_row_) return;
  const std::int64_t old_column = first_column_;
  const std::int64_t old_row = first_row_;
  first_column_ = column;
  first_row_ = row;
  for (std::int64_t i = 0; i < side_; ++i) {
    const auto slot = [&](std::int64_t index) {
      return static_cast<std::size_t>(((index % side_) + side_) % side_);
    };
    column_slots_[static_cast<std::size_t>(i)] = slot(first_column_ + i);
    row_slots_[static_cast<std::size_t>(i)] = slot(first_row_ + i) * static_cast<std::size_t>(side_);
  }
  if (!started_) return;
  for (std::int64_t r = first_row_; r < first_row_ + side_; ++r) {
    const bool old_row_left = r < old_row || r >= old_row + side_;
    for (std::int64_t c = first_column_; c < first_column_ + side_; ++c) {
      if (old_row_left || c < old_column || c >= old_column + side_) at(c, r) = ElevationCell();
    }
  }
}

/// Median difference in height over the ground that both know.
std::optional<double> ElevationGrid::offset_to(const ElevationRaster& raster) const {
  constexpr std::size_t kEnough = 50;
  std::vector<float> differences;
  // Every third cell in both axes says as much.
  for (int row = 0; row < raster.known.rows; row += 3) {
    for (int column = 0; column < raster.known.cols; column += 3) {
      const std::int64_t c = raster.first_column + column;
      const std::int64_t r = raster.first_row + row;
      if (raster.known.at<std::uint8_t>(row, column) == 0 || !inside(c, r)) continue;
      const ElevationCell& cell = at(c, r);
      if (cell.count > 0) differences.push_back(raster.mean_m.at<float>(row, column) - cell.mean_m);
    }
  }
  if (differences.size() < kEnough) return std::nullopt;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return static_cast<double>(*middle);
}

struct ElevationGrid::Sight {
  float mean_m;
  float top_m;
  float bottom_m;
  float measured_m;  // mean of the LiDAR returns; NaN, with which no comparison is true, where there is none
  bool obstacle;     // something rises or falls here
  bool clear;        // nothing does
};

void ElevationGrid::merge(std::int64_t t_ns, const Sight& sight, ElevationCell& cell) const {
  const auto moved_m = static_cast<float>(config_.moved_m);
  const bool moved = cell.count > 0 && std::abs(sight.mean_m - cell.mean_m) > moved_m &&
                     std::abs(sight.measured_m - cell.mean_m) > moved_m;
  const bool old_enough = to_seconds(t_ns - cell.obstacle_ns) > config_.forget_after_s;
  if (cell.has_obstacle() && sight.clear && old_enough) {
    cell.top_m = -std::numeric_limits<float>::infinity();
    cell.bottom_m = std::numeric_limits<float>::infinity();
    if (moved) cell.count = 0;  // what stood here is gone: the ground is what is seen now
  } else if (sight.obstacle || moved) {
    cell.top_m = std::max({cell.top_m, sight.top_m, moved ? cell.mean_m : sight.top_m});
    cell.bottom_m = std::min({cell.bottom_m, sight.bottom_m, moved ? cell.mean_m : sight.bottom_m});
    if (sight.obstacle || cell.obstacle_ns == 0) cell.obstacle_ns = t_ns;
  }
  if (cell.count == 0) cell.squares_m2 = 0;
  const auto limit = static_cast<float>(config_.max_count);
  if (cell.count >= limit) {
    cell.squares_m2 *= (limit - 1) / cell.count;
    cell.count = limit - 1;
  }
  cell.count += 1;
  const float delta_m = sight.mean_m - cell.mean_m;  // Welford; at count 1 the mean is the frame's
  cell.mean_m = cell.count > 1 ? cell.mean_m + delta_m / cell.count : sight.mean_m;
  if (cell.count > 1) cell.squares_m2 += delta_m * (sight.mean_m - cell.mean_m);
  cell.seen_ns = t_ns;
}

/// Holds what a predicted map shows in a cell against the returns there.
void ElevationGrid::vouch(const LidarReturns& returns, std::int64_t c, std::int64_t r, float ground_m,
                          Sight& sight) const {
  int column = 0;
  int row = 0;
  if (!returns.hit(c, r, column, row)) {
    sight.measured_m = std::numeric_limits<float>::quiet_NaN();
    sight.obstacle = sight.clear = false;
    return;
  }
  const auto limit = static_cast<float>(config_.obstacle_m);
  const bool stands_out = returns.top_m.at<float>(row, column) - ground_m > limit ||
                          ground_m - returns.bottom_m.at<float>(row, column) > limit;
  sight.measured_m = returns.mean_m.at<float>(row, column) - static_cast<float>(offset_m_);
  sight.obstacle = sight.obstacle && stands_out;
  sight.clear = sight.clear && !stands_out;
}

void ElevationGrid::add(std::int64_t t_ns, const ElevationRaster& raster, const GroundShape& shape,
                        const Eigen::Vector3d& p_world_camera, const LidarReturns* predicted_over) {
  if (t_ns < last_ns_) throw std::invalid_argument("ElevationGrid: frames must come in time order");
  last_ns_ = t_ns;
  if (raster.empty()) return;
  if (std::abs(raster.cell_m - config_.cell_m) > 1e-9)
    throw std::invalid_argument("ElevationGrid: the raster's cells have another size");
  recentre(p_world_camera);
  started_ = true;
  if (const auto offset_m = offset_to(raster)) {
    if (std::abs(*offset_m) > config_.max_height_offset_m) {
      std::fill(cells_.begin(), cells_.end(), ElevationCell());
      offset_m_ = 0;
      ++starts_;
    } else {
      offset_m_ = *offset_m;
    }
  }
  const auto offset = static_cast<float>(offset_m_);
  const auto limit = static_cast<float>(config_.obstacle_m);
  for (int row = 0; row < raster.known.rows; ++row) {
    for (int column = 0; column < raster.known.cols; ++column) {
      if (raster.known.at<std::uint8_t>(row, column) == 0) continue;
      const std::int64_t c = raster.first_column + column;
      const std::int64_t r = raster.first_row + row;
      if (!inside(c, r)) continue;
      const float centre_m = shape.centre_m.at<float>(row, column);
      const float top_m = raster.top_m.at<float>(row, column);
      const float bottom_m = raster.bottom_m.at<float>(row, column);
      const bool has_plane = shape.known.at<std::uint8_t>(row, column) != 0;
      const bool seen =
          has_plane ? shape.deviation_m.at<float>(row, column) > limit : top_m - bottom_m > 2 * limit;
      Sight sight{centre_m - offset, top_m - offset, bottom_m - offset, centre_m - offset, seen, !seen};
      if (predicted_over != nullptr) {
        const float ground_m = has_plane ? shape.plane_m.at<float>(row, column) : centre_m;
        vouch(*predicted_over, c, r, ground_m, sight);
      }
      merge(t_ns, sight, at(c, r));
    }
  }
}

LidarReturns ElevationGrid::returns_of(const cv::Mat& sparse_m, const PinholeIntrinsics& intrinsics,
                                       const Eigen::Isometry3d& T_world_camera) const {
  return lidar_returns(sparse_m, intrinsics, T_world_camera, config_.cell_m, config_.size_m,
                       config_.lidar_half_fov_deg);
}

void ElevationGrid::add_returns(const LidarReturns& returns, const Eigen::Isometry3d& T_world_camera) {
  if (config_.min_expected_returns <= 0 || !started_) return;
  for (int row = 0; row < returns.count.rows; ++row) {
    for (int column = 0; column < returns.count.cols; ++column) {
      const std::int64_t c = returns.first_column + column;
      const std::int64_t r = returns.first_row + row;
      if (inside(c, r)) at(c, r).returns += returns.count.at<float>(row, column);
    }
  }
  if (returns.within_fov == 0) return;
  const double limit = std::tan(to_radians(config_.lidar_half_fov_deg));
  // Returns are spread evenly over the field of view: a cell gets its share of the area at its depth.
  const double share =
      returns.within_fov * config_.cell_m * config_.cell_m / (3.141592653589793 * limit * limit);
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  for (std::int64_t r = first_row_; r < first_row_ + side_; ++r) {
    for (std::int64_t c = first_column_; c < first_column_ + side_; ++c) {
      ElevationCell& cell = at(c, r);
      if (cell.count == 0 || cell.seen_ns != last_ns_) continue;  // only what this frame has seen
      const Eigen::Vector3d p =
          T_camera_world * Eigen::Vector3d((static_cast<double>(c) + 0.5) * config_.cell_m,
                                           (static_cast<double>(r) + 0.5) * config_.cell_m,
                                           static_cast<double>(cell.mean_m) + offset_m_);
      if (p.z() <= 0 || p.head<2>().norm() > limit * p.z()) continue;
      cell.expected_returns += static_cast<float>(share / (p.z() * p.z()));
    }
  }
}

ElevationRaster ElevationGrid::raster() const {
  ElevationRaster out;
  out.cell_m = config_.cell_m;
  std::int64_t low_c = side_, low_r = side_, high_c = -1, high_r = -1;
  for (std::int64_t r = 0; started_ && r < side_; ++r) {
    for (std::int64_t c = 0; c < side_; ++c) {
      if (at(first_column_ + c, first_row_ + r).count == 0) continue;
      low_c = std::min(low_c, c);
      high_c = std::max(high_c, c);
      low_r = std::min(low_r, r);
      high_r = std::max(high_r, r);
    }
  }
  if (high_c < 0) return out;
  out.first_column = first_column_ + low_c;
  out.first_row = first_row_ + low_r;
  const cv::Size size(static_cast<int>(high_c - low_c + 1), static_cast<int>(high_r - low_r + 1));
  out.mean_m = cv::Mat::zeros(size, CV_32FC1);
  out.top_m = cv::Mat::zeros(size, CV_32FC1);
  out.bottom_m = cv::Mat::zeros(size, CV_32FC1);
  out.east_m = cv::Mat::zeros(size, CV_32FC1);  // the heights are those of the cells' middles
  out.north_m = cv::Mat::zeros(size, CV_32FC1);
  out.known = cv::Mat::zeros(size, CV_8UC1);
  const auto offset = static_cast<float>(offset_m_);
  for (int row = 0; row < size.height; ++row) {
    for (int column = 0; column < size.width; ++column) {
      const ElevationCell& cell = at(out.first_column + column, out.first_row + row);
      if (cell.count == 0) continue;
      out.known.at<std::uint8_t>(row, column) = 255;
      out.mean_m.at<float>(row, column) = cell.mean_m + offset;
      out.top_m.at<float>(row, column) = std::max(cell.mean_m, cell.top_m) + offset;
      out.bottom_m.at<float>(row, column) = std::min(cell.mean_m, cell.bottom_m) + offset;
    }
  }
  return out;
}

cv::Mat ElevationGrid::hazards(const ElevationRaster& raster) const {
  cv::Mat out = cv::Mat::zeros(raster.size(), CV_8UC1);
  if (config_.min_expected_returns <= 0) return out;
  for (int row = 0; row < out.rows; ++row) {
    for (int column = 0; column < out.cols; ++column) {
      const std::int64_t c = raster.first_column + column;
      const std::int64_t r = raster.first_row + row;
      if (!inside(c, r) || static_cast<double>(at(c, r).expected_returns) < config_.min_expected_returns)
        continue;
      float returns = 0;
      for (std::int64_t dr = -1; dr <= 1; ++dr) {
        for (std::int64_t dc = -1; dc <= 1; ++dc)
          returns += inside(c + dc, r + dr) ? at(c + dc, r + dr).returns : 0.F;
      }
      if (returns == 0) out.at<std::uint8_t>(row, column) = 255;
    }
  }
  return out;
}

cv::Mat ElevationGrid::obstacles(const ElevationRaster& raster) const {
  cv::Mat out = cv::Mat::zeros(raster.size(), CV_8UC1);
  for (int row = 0; row < out.rows; ++row) {
    for (int column = 0; column < out.cols; ++column) {
      const Eigen::Vector2d middle_m = raster.centre_m(column, row);
      const ElevationCell* remembered = cell(middle_m.x(), middle_m.y());
      if (remembered != nullptr && remembered->has_obstacle()) out.at<std::uint8_t>(row, column) = 255;
    }
  }
  return out;
}

}  // namespace alight
