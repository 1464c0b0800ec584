#include "infer/landing/planes/plane_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "geometry/wide_loops.hpp"

namespace alight {
namespace {

/// A cell of the disc. The disc is symmetric in both axes, so the normal equations of the plane are diagonal.
struct Offset {
  int row;
  int column;
  float east_m;
  float north_m;
};

std::vector<Offset> disc(double radius_m, double cell_m, int reach) {
  std::vector<Offset> offsets;
  for (int row = -reach; row <= reach; ++row) {
    for (int column = -reach; column <= reach; ++column) {
      if (std::hypot(row, column) * cell_m > radius_m + 1e-9) continue;
      offsets.push_back({row, column, static_cast<float>(column * cell_m), static_cast<float>(row * cell_m)});
    }
  }
  return offsets;
}

/// A plane a cell: height in the cell's middle and gradients, all CV_32FC1.
struct Planes {
  cv::Mat mean_m;
  cv::Mat east;
  cv::Mat north;
};

/// Adds the heights of one cell of the discs around each of `count` cells to the sums for their planes.
ALIGHT_WIDE_LOOPS void add_heights(int count, const float* z, float east_m, float north_m,
                                   float* __restrict mean, float* __restrict east, float* __restrict north) {
  for (int c = 0; c < count; ++c) {
    mean[c] += z[c];
    east[c] += east_m * z[c];
    north[c] += north_m * z[c];
  }
}

/// Loops over the disc outside, over the row inside: the compiler works on several cells at once.
Planes planes_through(const cv::Mat& height_m, const std::vector<Offset>& offsets, int reach) {
  Planes planes{cv::Mat::zeros(height_m.size(), CV_32FC1), cv::Mat::zeros(height_m.size(), CV_32FC1),
                cv::Mat::zeros(height_m.size(), CV_32FC1)};
  float squares = 0;
  for (const Offset& o : offsets) squares += o.east_m * o.east_m;
  const float per_cell = 1.F / static_cast<float>(offsets.size());
  const int count = height_m.cols - 2 * reach;
  for (int row = reach; row < height_m.rows - reach; ++row) {
    auto* const mean = planes.mean_m.ptr<float>(row) + reach;
    auto* const east = planes.east.ptr<float>(row) + reach;
    auto* const north = planes.north.ptr<float>(row) + reach;
    for (const Offset& o : offsets)
      add_heights(count, height_m.ptr<float>(row + o.row) + reach + o.column, o.east_m, o.north_m, mean, east,
                  north);
    for (int c = 0; c < count; ++c) {
      mean[c] *= per_cell;
      east[c] /= squares;
      north[c] /= squares;
    }
  }
  return planes;
}

/// Farthest that one cell of the discs around each of `count` cells lies from their planes, if farther than so far.
ALIGHT_WIDE_LOOPS void extend_residuals(int count, const float* top_m, const float* bottom_m, const Offset& o,
                                        const float* mean, const float* east, const float* north,
                                        float* __restrict residual_m) {
  const float east_m = o.east_m, north_m = o.north_m;
  for (int c = 0; c < count; ++c) {
    const float plane = mean[c] + east[c] * east_m + north[c] * north_m;
    const float above = top_m[c] - plane;
    const float below = plane - bottom_m[c];
    const float larger = above > below ? above : below;
    residual_m[c] = larger > residual_m[c] ? larger : residual_m[c];
  }
}

void residuals(const cv::Mat& top_m, const cv::Mat& bottom_m, int row, int begin, int end,
               const std::vector<Offset>& offsets, float half_cell_m, const Planes& planes,
               float* const residual_m, float* const deviation_m) {
  const float* const mean = planes.mean_m.ptr<float>(row);
  const float* const east = planes.east.ptr<float>(row);
  const float* const north = planes.north.ptr<float>(row);
  for (const Offset& o : offsets) {
    const int first = begin + o.column;
    extend_residuals(end - begin, top_m.ptr<float>(row + o.row) + first,
                     bottom_m.ptr<float>(row + o.row) + first, o, mean + begin, east + begin, north + begin,
                     residual_m + begin);
  }
  const float* const top = top_m.ptr<float>(row);
  const float* const bottom = bottom_m.ptr<float>(row);
  for (int c = begin; c < end; ++c) {
    const float above = top[c] - mean[c];
    const float below = mean[c] - bottom[c];
    deviation_m[c] = above > below ? above : below;
    // By so much a tilted plane alone rises from a cell's middle to its corner.
    const float tilt = half_cell_m * (std::abs(east[c]) + std::abs(north[c]));
    residual_m[c] = residual_m[c] > tilt ? residual_m[c] - tilt : 0.F;
    deviation_m[c] = deviation_m[c] > tilt ? deviation_m[c] - tilt : 0.F;
  }
}

/// Cells without a plane of their own take the mean of those around them that have one; 0 where there is none.
void extend_gradient(const cv::Mat& known, int reach, cv::Mat& gradient) {
  cv::Mat weight;
  known.convertTo(weight, CV_32FC1, 1 / 255.0);
  gradient = gradient.mul(weight);
  const cv::Size window(2 * reach + 1, 2 * reach + 1);
  cv::Mat sum;
  cv::Mat count;
  cv::boxFilter(gradient, sum, CV_32F, window, {-1, -1}, false, cv::BORDER_CONSTANT);
  cv::boxFilter(weight, count, CV_32F, window, {-1, -1}, false, cv::BORDER_CONSTANT);
  cv::Mat mean = sum / cv::max(count, 1.0);
  mean.copyTo(gradient, ~known);
}

}  // namespace

GroundShape fit_planes(const ElevationRaster& raster, const PlaneFitConfig& config) {
  const cv::Size size = raster.size();
  GroundShape shape{cv::Mat::zeros(size, CV_32FC1), cv::Mat::zeros(size, CV_32FC1),
                    cv::Mat::zeros(size, CV_32FC1), cv::Mat::zeros(size, CV_32FC1),
                    raster.mean_m.clone(),          cv::Mat::zeros(size, CV_8UC1)};
  const double radius_m = std::max(config.radius_m, raster.cell_m);
  const int reach = static_cast<int>(std::floor(radius_m / raster.cell_m + 1e-9));
  if (size.width <= 2 * reach || size.height <= 2 * reach) return shape;
  const std::vector<Offset> offsets = disc(radius_m, raster.cell_m, reach);
  cv::Mat kernel = cv::Mat::zeros(2 * reach + 1, 2 * reach + 1, CV_8UC1);
  for (const Offset& o : offsets) kernel.at<std::uint8_t>(o.row + reach, o.column + reach) = 1;
  cv::erode(raster.known, shape.known, kernel, {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  const cv::Mat unknown = ~shape.known;
  // Sums of large heights would cost digits.
  const cv::Scalar level_m = cv::mean(raster.mean_m, raster.known);
  const cv::Mat mean_m = raster.mean_m - level_m;
  Planes planes = planes_through(mean_m, offsets, reach);
  extend_gradient(shape.known, reach, planes.east);
  extend_gradient(shape.known, reach, planes.north);
  const cv::Mat centre_m = mean_m - planes.east.mul(raster.east_m) - planes.north.mul(raster.north_m);
  planes = planes_through(centre_m, offsets, reach);
  const cv::Mat top_m = raster.top_m - level_m;
  const cv::Mat bottom_m = raster.bottom_m - level_m;
  const auto half_cell_m = static_cast<float>(raster.cell_m / 2);
  for (int row = reach; row < size.height - reach; ++row) {
    residuals(top_m, bottom_m, row, reach, size.width - reach, offsets, half_cell_m, planes,
              shape.residual_m.ptr<float>(row), shape.deviation_m.ptr<float>(row));
  }
  cv::magnitude(planes.east, planes.north, shape.gradient);
  shape.plane_m = planes.mean_m + level_m;
  shape.plane_m.setTo(0, unknown);
  shape.centre_m = centre_m + level_m;
  shape.gradient.setTo(0, unknown);
  shape.residual_m.setTo(0, unknown);
  shape.deviation_m.setTo(0, unknown);
  return shape;
}

}  // namespace alight
