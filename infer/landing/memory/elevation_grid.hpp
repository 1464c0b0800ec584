#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "infer/landing/ground/ground_map.hpp"
#include "infer/landing/memory/lidar_support.hpp"

namespace alight {

/// What is remembered of the ground, and for how long.
struct ElevationGridConfig {
  double cell_m = 0.2;
  double size_m = 80;  ///< side of the window that moves with the vehicle; ground that leaves it is forgotten
  /// Something that rises or falls farther from a frame's plane is an obstacle, and one sight of it is enough: it keeps
  /// its height whatever the mean becomes. In a predicted map only where a LiDAR return says so, too.
  double obstacle_m = 0.15;
  /// A frame whose ground differs by more from the remembered one has seen something come or go; both heights are kept.
  double moved_m = 0.3;
  /// An obstacle is forgotten only where its place is seen without it, and not sooner than this after the last sight.
  double forget_after_s = 30;
  /// Frames count so many times at most, so that the mean follows the ground.
  int max_count = 50;
  /// All heights of a frame are shifted to agree with the grid; if they differ by more the grid starts anew.
  double max_height_offset_m = 2;
  // Places without LiDAR returns.
  double lidar_half_fov_deg = 17;  ///< around the optical axis, inside the LiDAR's own field of view
  /// Ground on which so many returns a cell were due and none came, neither here nor in the cells around, is a hazard:
  /// water, glass. 0: off.
  double min_expected_returns = 10;
};
void bind(Binder& b, ElevationGridConfig& c);

/// One cell. Heights are the world's z as the first frames saw it.
struct ElevationCell {
  float count = 0;  ///< frames, at most max_count; 0: unknown
  float mean_m = 0;
  float squares_m2 = 0;  ///< sum of squared distances to the mean, over count
  float top_m = -std::numeric_limits<float>::infinity();    ///< of the highest obstacle
  float bottom_m = std::numeric_limits<float>::infinity();  ///< of the deepest hole
  float expected_returns = 0;
  float returns = 0;
  std::int64_t seen_ns = 0;
  std::int64_t obstacle_ns = 0;  ///< when top_m or bottom_m was last seen

  double variance_m2() const { return count > 1 ? static_cast<double>(squares_m2 / count) : 0; }
  bool has_obstacle() const { return top_m > -1e30F || bottom_m < 1e30F; }
};

/// A world-fixed raster of the ground, fused over frames with the vehicle's pose: what was seen is remembered when the
/// view moves on. Memory is bounded by the window.
class ElevationGrid {
 public:
  explicit ElevationGrid(const ElevationGridConfig& config);

  /// Adds a frame. Frames must come in time order.
  /// @param raster cells of config.cell_m. @param shape its planes
  /// @param predicted_over of a predicted map, the LiDAR points in it: what a network alone imagines would be
  /// remembered as firmly as what was measured, so without a point a cell's obstacles stay as they were. Null for a
  /// measured map.
  /// @throws std::invalid_argument
  void add(std::int64_t t_ns, const ElevationRaster& raster, const GroundShape& shape,
           const Eigen::Vector3d& p_world_camera, const LidarReturns* predicted_over = nullptr);

  /// Counts the LiDAR returns of the frame added last, and those that were due on the ground that it knows.
  void add_returns(const LidarReturns& returns, const Eigen::Isometry3d& T_world_camera);

  /// A frame's LiDAR points in cells of this grid. @param sparse_m CV_32FC1 plane depth of the points, 0 = none
  LidarReturns returns_of(const cv::Mat& sparse_m, const PinholeIntrinsics& intrinsics,
                          const Eigen::Isometry3d& T_world_camera) const;

  /// The remembered ground as a raster that planes can be fitted to; in the heights of the latest frame's pose.
  ElevationRaster raster() const;
  /// CV_8UC1 of raster()'s size, 255 = no LiDAR returns where they were due.
  cv::Mat hazards(const ElevationRaster& raster) const;

  /// CV_8UC1 of the raster's size, 255 = over the cell's middle something is remembered that rises or falls. Cells of any
  /// size.
  cv::Mat obstacles(const ElevationRaster& raster) const;

  /// The cell over a place; null outside the window. count == 0: unknown.
  const ElevationCell* cell(double east_m, double north_m) const;
  /// Added to the grid's heights they are those of the latest frame.
  double height_offset_m() const { return offset_m_; }
  int starts() const { return starts_; }  ///< how often the grid began anew because heights jumped
  const ElevationGridConfig& config() const { return config_; }
  std::size_t bytes() const { return cells_.size() * sizeof(ElevationCell); }

 private:
  struct Sight;  ///< what one frame says of a cell
  void recentre(const Eigen::Vector3d& p_world_camera);
  std::optional<double> offset_to(const ElevationRaster& raster) const;
  void merge(std::int64_t t_ns, const Sight& sight, ElevationCell& cell) const;
  void vouch(const LidarReturns& returns, std::int64_t column, std::int64_t row, float ground_m,
             Sight& sight) const;
  bool inside(std::int64_t column, std::int64_t row) const;
  ElevationCell& at(std::int64_t column, std::int64_t row);
  const ElevationCell& at(std::int64_t column, std::int64_t row) const;

  ElevationGridConfig config_;
  std::int64_t side_;
  std::int64_t first_column_ = 0;
  std::int64_t first_row_ = 0;
  bool started_ = false;
  std::int64_t last_ns_ = std::numeric_limits<std::int64_t>::min();
  double offset_m_ = 0;
  int starts_ = 0;
  // A ring in both axes: a cell keeps its slot while the window moves.
  std::vector<std::size_t> column_slots_;  // of the window's columns
  std::vector<std::size_t> row_slots_;     // of its rows, times side_
  std::vector<ElevationCell> cells_;
};

}  // namespace alight
