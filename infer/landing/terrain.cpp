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

/// A mean over a window that touches an unknown pixel would be lopsided, so it is unknown too. 0 is unknown.
cv::Mat smooth(const cv::Mat& depth_m, int window_px) {
  cv::Mat known = depth_m > 0;
  cv::Mat inverse;
  cv::divide(1.0, depth_m, inverse);
  inverse.setTo(0, ~known);
  const cv::Size window(window_px, window_px);
  if (window_px > 1) {
    cv::boxFilter(inverse, inverse, CV_32F, window, {-1, -1}, true, cv::BORDER_REPLICATE);
    cv::erode(known, known, cv::getStructuringElement(cv::MORPH_RECT, window), {-1, -1}, 1,
              cv::BORDER_CONSTANT, cv::Scalar(0));
  }
  cv::Mat smoothed_m;
  cv::divide(1.0, inverse, smoothed_m);
  smoothed_m.setTo(0, ~known);
  return smoothed_m;
}

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
Angle inclination(const Eigen::Vector3d& along_row, const Eigen::Vector3d& along_column) {
  const Eigen::Vector3d normal = along_row.cross(along_column);
  if (normal.z() <= 0) return {1, 0};
  return {normal.head<2>().norm(), normal.z()};
}

/// Sines and cosines of a row of pixels, so that the arc tangents are taken of many at once.
class AngleRow {
 public:
  explicit AngleRow(int width) : sine_(static_cast<std::size_t>(width), 0.F), cosine_(sine_.size(), 1.F) {}
  void set(int u, const Angle& angle) {
    sine_[static_cast<std::size_t>(u)] = static_cast<float>(angle.sine);
    cosine_[static_cast<std::size_t>(u)] = static_cast<float>(angle.cosine);
  }
  void write_rad(float* out) const {
    for (std::size_t u = 0; u < sine_.size(); ++u) out[u] = arc_rad(sine_[u], cosine_[u]);
  }

 private:
  /// atan2 for a sine that is not negative, free of branches, right to 3e-7. Below tan(22.5 deg) the quotient of an odd
  /// polynomial of least largest relative error, between there and 1 after taking off 45 degrees.
  static float arc_rad(float sine, float cosine) {
    constexpr float kEighth_rad = 0.78539816339744831F;
    constexpr float kTan22 = 0.41421356237309505F;
    const float across = std::abs(cosine);
    const float larger = sine > across ? sine : across;
    const float smaller = sine > across ? across : sine;
    const bool upper = smaller > kTan22 * larger;
    const float numerator = upper ? smaller - larger : smaller;
    const float denominator = upper ? smaller + larger : larger;
    const float x = numerator / denominator;
    const float z = x * x;
    const float polynomial =
        ((((-0.06026305237F * z + 0.105698288104F) * z - 0.142395326703F) * z + 0.199981830411F) * z -
         0.333333068931F) *
            z +
        0.999999999371F;
    float angle = polynomial * x + (upper ? kEighth_rad : 0.F);
    angle = sine > across ? kVertical_rad - angle : angle;
    return cosine < 0 ? 2 * kVertical_rad - angle : angle;
  }

  std::vector<float> sine_;
  std::vector<float> cosine_;
};

/// Shape of the ground from one row of the smoothed depth.
class RowMeasure {
 public:
  RowMeasure(const cv::Mat& depth_m, const PinholeIntrinsics& k, double baseline_m)
      : depth_m_(depth_m), baseline_px_m_(baseline_m * k.fx_px) {
    for (int u = 0; u < k.width_px; ++u) x_.push_back(k.ray(u, 0).x());
    for (int v = 0; v < k.height_px; ++v) y_.push_back(k.ray(0, v).y());
  }

  void operator()(int v, Terrain& terrain) const {
    const int width = depth_m_.cols;
    AngleRow slope(width);
    AngleRow roughness(width);
    const auto* const row = depth_m_.ptr<float>(v);
    auto* const known = terrain.known.ptr<std::uint8_t>(v);
    for (int u = 0; u < width; ++u) {
      if (!(row[u] > 0)) continue;
      const double pixels = std::min(1e6, std::max(1.0, baseline_px_m_ / static_cast<double>(row[u])));
      const int step = static_cast<int>(pixels + 0.5);
      if (u < step || v < step || u + step >= width || v + step >= depth_m_.rows) continue;
      const float up_m = depth_m_.ptr<float>(v - step)[u];
      const float down_m = depth_m_.ptr<float>(v + step)[u];
      if (!(row[u - step] > 0 && row[u + step] > 0 && up_m > 0 && down_m > 0)) continue;
      const Eigen::Vector3d centre = point(u, v, row[u]);
      const Eigen::Vector3d left = point(u - step, v, row[u - step]);
      const Eigen::Vector3d right = point(u + step, v, row[u + step]);
      const Eigen::Vector3d up = point(u, v - step, up_m);
      const Eigen::Vector3d down = point(u, v + step, down_m);
      known[u] = 255;
      slope.set(u, inclination(right - left, down - up));
      const Angle along_row = bend(left, centre, right, 0);
      const Angle along_column = bend(up, centre, down, 1);
      roughness.set(u, larger(along_column, along_row) ? along_column : along_row);
    }
    slope.write_rad(terrain.slope_rad.ptr<float>(v));
    roughness.write_rad(terrain.roughness_rad.ptr<float>(v));
  }

 private:
  /// x and y on the ground, z the depth.
  Eigen::Vector3d point(int u, int v, float depth_m) const {
    const auto z = static_cast<double>(depth_m);
    return {x_[static_cast<std::size_t>(u)] * z, y_[static_cast<std::size_t>(v)] * z, z};
  }

  const cv::Mat& depth_m_;  // 0: unknown
  double baseline_px_m_;
  std::vector<double> x_;
  std::vector<double> y_;
};

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
  const cv::Mat smoothed_m = smooth(level_depth_m, config.smoothing_px);
  const RowMeasure measure_row(smoothed_m, intrinsics, config.derivative_baseline_m);
  cv::parallel_for_({0, size.height}, [&](const cv::Range& rows) {
    for (int v = rows.start; v < rows.end; ++v) measure_row(v, terrain);
  });
  return terrain;
}

}  // namespace alight
