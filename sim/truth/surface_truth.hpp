#pragma once

#include <optional>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "foundation/binder_fwd.hpp"
#include "geometry/camera.hpp"
#include "sim/render/renderer.hpp"

namespace alight::sim {

/// What counts as safe ground. A cell is safe when, over all cells within `radius_m`: the top surface is
/// landable ground (no water, roof, plant, car: whatever hangs over the ground is the top surface), the
/// least-squares plane is less steep than `max_slope_deg`, and no cell is farther from that plane than
/// `max_residual_m`, measured vertically.
struct SurfaceTruthConfig {
  double cell_m = 0.2;
  double radius_m = 0.6;
  double max_slope_deg = 10.0;
  double max_residual_m = 0.10;
  double surface_tolerance_m = 0.2;  ///< a pixel shows a cell's top surface if its height is this close to it
};
void bind(Binder& b, SurfaceTruthConfig& c);

/// A circle of safe ground.
struct SafeCircle {
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  double radius_m = 0;  ///< 0: there is none
};

/// What is true of a cell.
struct GroundCell {
  double elevation_m = 0;  ///< of the top surface; NaN where nothing was hit
  double slope_rad = 0;    ///< NaN at the grid's border
  double residual_m = 0;   ///< NaN at the grid's border
  bool landable = false;
  bool safe = false;
};

/// True elevation, slope and safety of a world, on a grid over its detailed square, seen from straight above.
/// Maps are row = y, column = x: cell (r, c) is centred at (min + (c + 0.5) cell, min + (r + 0.5) cell), min
/// = -size/2.
class SurfaceTruth {
 public:
  /// @param t_s from the start of the flight: where what moves is
  explicit SurfaceTruth(const Renderer& renderer, const SurfaceTruthConfig& config = {}, double t_s = 0);

  const cv::Mat& elevation_m() const { return elevation_m_; }  ///< CV_32FC1, NaN where nothing was hit
  const cv::Mat& slope_rad() const { return slope_rad_; }      ///< CV_32FC1 of the local plane
  /// CV_32FC1, largest distance to the local plane
  const cv::Mat& residual_m() const { return residual_m_; }
  const cv::Mat& safe() const { return safe_; }  ///< CV_8UC1, 255 = safe
  const cv::Mat& clearance_m() const {
    return clearance_m_;
  }  ///< CV_32FC1, distance to the nearest unsafe cell

  /// Empty outside the grid.
  std::optional<GroundCell> ground_at(double x_m, double y_m) const;
  /// False outside the grid.
  bool is_safe(double x_m, double y_m) const;
  /// Radius of safe ground around a place; 0 outside the grid.
  double clearance_m(double x_m, double y_m) const;
  /// NaN outside the grid.
  double elevation_m(double x_m, double y_m) const;
  /// The largest circle of safe ground whose centre has |x|, |y| <= half_width_m.
  SafeCircle largest_safe_circle(double half_width_m) const;

  /// Safe ground in an image: the pixel's point is its cell's top surface and the cell is safe.
  /// @param depth_m CV_32FC1 plane depth, 0 = sky. @returns CV_8UC1, 255 = safe
  cv::Mat safe_mask(const cv::Mat& depth_m, const PinholeIntrinsics& intrinsics,
                    const Eigen::Isometry3d& T_world_camera) const;

 private:
  void measure_elevation(const Renderer& renderer, double t_s);
  void fit_planes();
  bool cell_at(double x_m, double y_m, int& row, int& column) const;

  SurfaceTruthConfig config_;
  double min_m_ = 0;
  cv::Mat elevation_m_;
  cv::Mat landable_;
  cv::Mat slope_rad_;
  cv::Mat residual_m_;
  cv::Mat safe_;
  cv::Mat clearance_m_;
};

}  // namespace alight::sim
