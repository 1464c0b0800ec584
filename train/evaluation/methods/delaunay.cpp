#include "train/evaluation/methods/delaunay.hpp"

#include <algorithm>
#include <vector>

#include "geometry/depth_map.hpp"
#include "train/evaluation/methods/triangulation.hpp"

namespace alight {
namespace {

struct Corner {
  cv::Point pixel;
  double value;
};

/// Rounds towards minus infinity; b > 0.
int floor_divide(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

/// The pixels of a row inside a triangle whose corners turn left in (x, y).
cv::Range columns_inside(const std::array<Corner, 3>& corners, int y, int width) {
  cv::Range range(0, width);
  for (std::size_t i = 0; i < 3; ++i) {
    const cv::Point from = corners[i].pixel;
    const cv::Point along = corners[(i + 1) % 3].pixel - from;
    const int crossing = along.x * (y - from.y);  // over along.y, right of from.x
    if (along.y > 0) range.end = std::min(range.end, from.x + floor_divide(crossing, along.y) + 1);
    if (along.y < 0) range.start = std::max(range.start, from.x - floor_divide(crossing, -along.y));
  }
  return range;
}

void rasterise(const std::array<Corner, 3>& corners, LinearQuantity quantity, cv::Mat& out) {
  const auto& [a, b, c] = corners;
  const cv::Point ab = b.pixel - a.pixel;
  const cv::Point ac = c.pixel - a.pixel;
  const double area = static_cast<double>(ab.x * ac.y - ab.y * ac.x);
  const double step_x = ((b.value - a.value) * ac.y - (c.value - a.value) * ab.y) / area;
  const double step_y = ((c.value - a.value) * ab.x - (b.value - a.value) * ac.x) / area;
  const auto [top, bottom] = std::minmax({a.pixel.y, b.pixel.y, c.pixel.y});
  for (int y = top; y <= bottom; ++y) {
    const cv::Range columns = columns_inside(corners, y, out.cols);
    float* row = out.ptr<float>(y);
    for (int x = columns.start; x < columns.end; ++x) {
      const double value = a.value + step_x * (x - a.pixel.x) + step_y * (y - a.pixel.y);
      row[x] = static_cast<float>(quantity == LinearQuantity::kDepth ? value : 1 / value);
    }
  }
}

}  // namespace

cv::Mat fill_delaunay(const cv::Mat& sparse_m, LinearQuantity quantity) {
  cv::Mat filled = fill_nearest(sparse_m);  // what is outside the hull stays
  std::vector<cv::Point> pixels;
  cv::findNonZero(sparse_m > 0, pixels);
  const auto corner = [&](int index) {
    const cv::Point pixel = pixels[static_cast<std::size_t>(index)];
    const auto depth_m = static_cast<double>(sparse_m.at<float>(pixel));
    return Corner{pixel, quantity == LinearQuantity::kDepth ? depth_m : 1 / depth_m};
  };
  for (const auto& [a, b, c] : triangulate(pixels)) {
    rasterise({corner(a), corner(b), corner(c)}, quantity, filled);
  }
  sparse_m.copyTo(filled, sparse_m > 0);  // bit for bit
  return filled;
}

}  // namespace alight
