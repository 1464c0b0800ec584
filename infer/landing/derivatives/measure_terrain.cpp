#include "infer/landing/derivatives/measure_terrain.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Core>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "geometry/wide_loops.hpp"

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
  float sine;
  float cosine;
};

/// The angle between two steps over the ground, one after the other on an image row or column: their lengths on the
/// ground and how far they go down. On a plane it is zero. A step that does not lead forward is a fold: 90 degrees.
Angle bend(float forward1, float ground1_m, float down1_m, float forward2, float ground2_m, float down2_m) {
  const bool fold = !(forward1 > 0) | !(forward2 > 0);
  return {fold ? 1.F : std::abs(down2_m * ground1_m - down1_m * ground2_m),
          fold ? 0.F : ground1_m * ground2_m + down1_m * down2_m};
}

/// atan2 for a sine that is not negative, free of branches, right to 3e-7. Below tan(22.5 deg) the quotient of an odd
/// polynomial of least largest relative error, between there and 1 after taking off 45 degrees.
float arc_rad(const Angle& a) {
  constexpr float kEighth_rad = 0.78539816339744831F;
  constexpr float kTan22 = 0.41421356237309505F;
  const float across = std::abs(a.cosine);
  const float larger = a.sine > across ? a.sine : across;
  const float smaller = a.sine > across ? across : a.sine;
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
  angle = a.sine > across ? kVertical_rad - angle : angle;
  return a.cosine < 0 ? 2 * kVertical_rad - angle : angle;
}

/// What a row of pixels compares: its own depths and those a step away, as separate arrays for vector instructions.
/// Where one of the depths is missing all are those of level ground.
struct RowDepths {
  explicit RowDepths(int width)
      : step(width),
        centre_m(width),
        left_m(width),
        right_m(width),
        up_m(width),
        down_m(width),
        step_px(width) {}
  Eigen::ArrayXi step;
  Eigen::ArrayXf centre_m, left_m, right_m, up_m, down_m, step_px;
};

/// By how many pixels the baseline reaches at every depth of a row; 0 where the depth is unknown or that leads out of
/// the image.
/// @param rows that there are above and below
ALIGHT_WIDE_LOOPS void steps_of_row(int width, const float* depth_m, float baseline_px_m, int rows,
                                    int* __restrict step) {
  for (int u = 0; u < width; ++u) {
    const float known_m = depth_m[u] > 0 ? depth_m[u] : 1.F;
    const float reach = baseline_px_m / known_m;
    const float at_least_one = reach > 1.F ? reach : 1.F;
    const int pixels = static_cast<int>((at_least_one < 1e6F ? at_least_one : 1e6F) + 0.5F);
    const int to_border = u < width - 1 - u ? u : width - 1 - u;
    step[u] = depth_m[u] > 0 && pixels <= to_border && pixels <= rows ? pixels : 0;
  }
}

/// @param per_x, per_y one over the focal lengths in pixels
/// @param ray_x of every column, ray_y of the row, at unit depth
ALIGHT_WIDE_LOOPS void shape_of_row(int width, const float* centre_m, const float* left_m,
                                    const float* right_m, const float* up_m, const float* down_m,
                                    const float* step_px, const float* ray_x, float ray_y, float per_x,
                                    float per_y, float* __restrict slope_rad,
                                    float* __restrict roughness_rad) {
  for (int u = 0; u < width; ++u) {
    const float z = centre_m[u], l = left_m[u], r = right_m[u], t = up_m[u], d = down_m[u];
    const float dx = step_px[u] * per_x, dy = step_px[u] * per_y;
    // Two steps along the row, two along the column; x and y lie on the ground, z goes down.
    const float row1_x = ray_x[u] * (z - l) + dx * l, row1_y = ray_y * (z - l), row1_z = z - l;
    const float row2_x = ray_x[u] * (r - z) + dx * r, row2_y = ray_y * (r - z), row2_z = r - z;
    const float column1_x = ray_x[u] * (z - t), column1_y = ray_y * (z - t) + dy * t, column1_z = z - t;
    const float column2_x = ray_x[u] * (d - z), column2_y = ray_y * (d - z) + dy * d, column2_z = d - z;
    const Angle along_row = bend(row1_x, std::sqrt(row1_x * row1_x + row1_y * row1_y), row1_z, row2_x,
                                 std::sqrt(row2_x * row2_x + row2_y * row2_y), row2_z);
    const Angle along_column =
        bend(column1_y, std::sqrt(column1_x * column1_x + column1_y * column1_y), column1_z, column2_y,
             std::sqrt(column2_x * column2_x + column2_y * column2_y), column2_z);
    const bool column_larger = along_column.sine * along_row.cosine > along_row.sine * along_column.cosine;
    roughness_rad[u] = arc_rad({column_larger ? along_column.sine : along_row.sine,
                                column_larger ? along_column.cosine : along_row.cosine});
    // Inclination of the plane that both spans span.
    const float ax = row1_x + row2_x, ay = row1_y + row2_y, az = row1_z + row2_z;
    const float bx = column1_x + column2_x, by = column1_y + column2_y, bz = column1_z + column2_z;
    const float normal_x = ay * bz - az * by, normal_y = az * bx - ax * bz, normal_z = ax * by - ay * bx;
    const bool upright = !(normal_z > 0);
    slope_rad[u] = arc_rad(
        {upright ? 1.F : std::sqrt(normal_x * normal_x + normal_y * normal_y), upright ? 0.F : normal_z});
  }
}

/// Shape of the ground from one row of the smoothed depth.
class RowMeasure {
 public:
  RowMeasure(const cv::Mat& depth_m, const PinholeIntrinsics& k, double baseline_m)
      : depth_m_(depth_m),
        k_(k),
        baseline_px_m_(static_cast<float>(baseline_m * k.fx_px)),
        ray_x_(k.width_px) {
    for (int u = 0; u < k.width_px; ++u) ray_x_[u] = static_cast<float>(k.ray(u, 0).x());
  }

  void operator()(int v, RowDepths& depths, Terrain& terrain) const {
    look_around(v, depths, terrain.known.ptr<std::uint8_t>(v));
    auto* const slope_rad = terrain.slope_rad.ptr<float>(v);
    auto* const roughness_rad = terrain.roughness_rad.ptr<float>(v);
    shape_of_row(depth_m_.cols, depths.centre_m.data(), depths.left_m.data(), depths.right_m.data(),
                 depths.up_m.data(), depths.down_m.data(), depths.step_px.data(), ray_x_.data(),
                 static_cast<float>(k_.ray(0, v).y()), static_cast<float>(1 / k_.fx_px),
                 static_cast<float>(1 / k_.fy_px), slope_rad, roughness_rad);
  }

 private:
  void look_around(int v, RowDepths& depths, std::uint8_t* known) const {
    const int width = depth_m_.cols;
    const auto* const row = depth_m_.ptr<float>(v);
    const auto stride = static_cast<std::ptrdiff_t>(depth_m_.step1());  // a row down
    steps_of_row(width, row, baseline_px_m_, std::min(v, depth_m_.rows - 1 - v), depths.step.data());
    for (int u = 0; u < width; ++u) {
      const int step = depths.step[u];
      float left_m = 0, right_m = 0, up_m = 0, down_m = 0;
      if (step > 0) {
        left_m = row[u - step];
        right_m = row[u + step];
        up_m = row[u - step * stride];
        down_m = row[u + step * stride];
      }
      const bool all = left_m > 0 && right_m > 0 && up_m > 0 && down_m > 0;
      known[u] = all ? 255 : 0;
      depths.centre_m[u] = all ? row[u] : 1.F;
      depths.left_m[u] = all ? left_m : 1.F;
      depths.right_m[u] = all ? right_m : 1.F;
      depths.up_m[u] = all ? up_m : 1.F;
      depths.down_m[u] = all ? down_m : 1.F;
      depths.step_px[u] = static_cast<float>(std::max(step, 1));
    }
  }

  const cv::Mat& depth_m_;  // 0: unknown
  const PinholeIntrinsics& k_;
  float baseline_px_m_;
  Eigen::ArrayXf ray_x_;
};

}  // namespace

Terrain measure_terrain(const cv::Mat& level_depth_m, const PinholeIntrinsics& intrinsics,
                        const DerivativesConfig& config) {
  if (level_depth_m.type() != CV_32FC1 || level_depth_m.size() != intrinsics.size()) {
    throw std::invalid_argument("measure_terrain: depth must be CV_32FC1 of the camera's size");
  }
  const cv::Size size = level_depth_m.size();
  Terrain terrain{cv::Mat(size, CV_32FC1, cv::Scalar(0)), cv::Mat(size, CV_32FC1, cv::Scalar(0)),
                  cv::Mat(size, CV_8UC1, cv::Scalar(0))};
  const cv::Mat smoothed_m = smooth(level_depth_m, config.smoothing_px);
  const RowMeasure measure_row(smoothed_m, intrinsics, config.derivative_baseline_m);
  cv::parallel_for_({0, size.height}, [&](const cv::Range& rows) {
    RowDepths depths(size.width);
    for (int v = rows.start; v < rows.end; ++v) measure_row(v, depths, terrain);
  });
  return terrain;
}

}  // namespace alight
