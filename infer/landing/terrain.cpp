#include "infer/landing/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

namespace alight {
namespace {

constexpr float kVertical_rad = 1.57079632679489662F;

struct Smoothed {
  cv::Mat depth_m;
  cv::Mat known;
};

/// A mean over a window that touches an unknown pixel would be lopsided, so it is unknown too.
Smoothed smooth(const cv::Mat& depth_m, int window_px) {
  Smoothed out;
  out.known = depth_m > 0;
  cv::Mat inverse;
  cv::divide(1.0, depth_m, inverse);
  inverse.setTo(0, ~out.known);
  const cv::Size window(window_px, window_px);
  if (window_px > 1) {
    cv::boxFilter(inverse, inverse, CV_32F, window, {-1, -1}, true, cv::BORDER_REPLICATE);
    cv::erode(out.known, out.known, cv::getStructuringElement(cv::MORPH_RECT, window), {-1, -1}, 1,
              cv::BORDER_CONSTANT, cv::Scalar(0));
  }
  cv::divide(1.0, inverse, out.depth_m);
  out.depth_m.setTo(0, ~out.known);
  return out;
}

/// The points of the pixels: x and y on the ground, z the depth. Coordinates of the image axes are looked up.
class Points {
 public:
  Points(const Smoothed& smoothed, const PinholeIntrinsics& k) : smoothed_(smoothed) {
    for (int u = 0; u < k.width_px; ++u) x_.push_back(k.ray(u, 0).x());
    for (int v = 0; v < k.height_px; ++v) y_.push_back(k.ray(0, v).y());
  }

  bool known(int u, int v) const {
    return u >= 0 && v >= 0 && u < smoothed_.known.cols && v < smoothed_.known.rows &&
           smoothed_.known.at<std::uint8_t>(v, u) != 0;
  }
  double depth_m(int u, int v) const { return static_cast<double>(smoothed_.depth_m.at<float>(v, u)); }
  Eigen::Vector3d at(int u, int v) const {
    const double z = depth_m(u, v);
    return {x_[static_cast<std::size_t>(u)] * z, y_[static_cast<std::size_t>(v)] * z, z};
  }

 private:
  const Smoothed& smoothed_;
  std::vector<double> x_;
  std::vector<double> y_;
};

/// An angle of 0 to 180 degrees as sine and cosine of any common length: comparing two needs no arc tangent.
struct Angle {
  double sine = 0;
  double cosine = 1;
};
bool larger(const Angle& a, const Angle& b) { return a.sine * b.cosine > b.sine * a.cosine; }

/// The angle by which the slope changes at `centre` on the way from `before` to `after`, which lie on one image row
/// (axis 0) or column (axis 1): on a plane these three are on a line and the angle is zero.
Angle bend(const Eigen::Vector3d& before, const Eigen::Vector3d& centre, const Eigen::Vector3d& after,
           int axis) {
  const Eigen::Vector3d first = centre - before;
  const Eigen::Vector3d second = after - centre;
  if (first[axis] <= 0 || second[axis] <= 0) return {1, 0};
  const double ground_first = first.head<2>().norm();
  const double ground_second = second.head<2>().norm();
  return {std::abs(second.z() * ground_first - first.z() * ground_second),
          ground_first * ground_second + first.z() * second.z()};
}

/// Inclination of the plane spanned by two differences, one along the row and one along the column.
float slope_rad(const Eigen::Vector3d& along_row, const Eigen::Vector3d& along_column) {
  const Eigen::Vector3d normal = along_row.cross(along_column);
  if (normal.z() <= 0) return kVertical_rad;
  return std::atan2(static_cast<float>(normal.head<2>().norm()), static_cast<float>(normal.z()));
}

}  // namespace

void bind(Binder& b, TerrainConfig& c) {
  b.field("derivative_baseline_m", c.derivative_baseline_m,
          "ground distance that slope and roughness compare", between(0.05, 10));
  b.field("smoothing_px", c.smoothing_px, "side of the averaging window, odd; 1: none", between(1, 31));
  b.check("smoothing_px", c.smoothing_px % 2 == 1, "must be odd, so that the window has a centre");
}

Terrain measure_terrain(const cv::Mat& level_depth_m, const PinholeIntrinsics& intrinsics,
                        const TerrainConfig& config) {
  if (level_depth_m.type() != CV_32FC1 || level_depth_m.size() != intrinsics.size()) {
    throw std::invalid_argument("measure_terrain: depth must be CV_32FC1 of the camera's size");
  }
  const cv::Size size = level_depth_m.size();
  Terrain terrain{cv::Mat(size, CV_32FC1, cv::Scalar(0)), cv::Mat(size, CV_32FC1, cv::Scalar(0)),
                  cv::Mat(size, CV_8UC1, cv::Scalar(0))};
  const Smoothed smoothed = smooth(level_depth_m, config.smoothing_px);
  const Points points(smoothed, intrinsics);
  const double baseline_px_m = config.derivative_baseline_m * intrinsics.fx_px;
  const auto measure_row = [&](int v) {
    for (int u = 0; u < size.width; ++u) {
      if (!points.known(u, v)) continue;
      const int step =
          static_cast<int>(std::min(1e6, std::max(1.0, std::round(baseline_px_m / points.depth_m(u, v)))));
      if (!points.known(u - step, v) || !points.known(u + step, v) || !points.known(u, v - step) ||
          !points.known(u, v + step)) {
        continue;
      }
      const Eigen::Vector3d centre = points.at(u, v);
      const Eigen::Vector3d left = points.at(u - step, v);
      const Eigen::Vector3d right = points.at(u + step, v);
      const Eigen::Vector3d up = points.at(u, v - step);
      const Eigen::Vector3d down = points.at(u, v + step);
      terrain.known.at<std::uint8_t>(v, u) = 255;
      terrain.slope_rad.at<float>(v, u) = slope_rad(right - left, down - up);
      const Angle along_row = bend(left, centre, right, 0);
      const Angle along_column = bend(up, centre, down, 1);
      const Angle& roughest = larger(along_column, along_row) ? along_column : along_row;
      terrain.roughness_rad.at<float>(v, u) =
          std::atan2(static_cast<float>(roughest.sine), static_cast<float>(roughest.cosine));
    }
  };
  cv::parallel_for_({0, size.height}, [&](const cv::Range& rows) {
    for (int v = rows.start; v < rows.end; ++v) measure_row(v);
  });
  return terrain;
}

}  // namespace alight
