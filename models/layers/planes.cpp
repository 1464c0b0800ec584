#include "models/layers/planes.hpp"

#include <algorithm>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace alight {
namespace {

/// How many of the `side` neighbours around each of `length` places lie inside, as a factor that makes a mean of a sum.
std::vector<float> mean_factors(int length, int side) {
  std::vector<float> factors(static_cast<std::size_t>(length));
  for (int i = 0; i < length; ++i) {
    const int inside = std::min(i, side / 2) + std::min(length - 1 - i, side / 2) + 1;
    factors[static_cast<std::size_t>(i)] = 1.0F / static_cast<float>(inside);
  }
  return factors;
}

}  // namespace

bool has_planes(const torch::Tensor& x) {
  return x.device().is_cpu() && x.scalar_type() == torch::kFloat32 && x.dim() == 4 &&
         !(torch::GradMode::is_enabled() && x.requires_grad());
}

cv::Mat plane_of(const torch::Tensor& x, std::int64_t sample, std::int64_t channel) {
  const std::int64_t pixels = x.size(2) * x.size(3);
  return {static_cast<int>(x.size(2)), static_cast<int>(x.size(3)), CV_32FC1,
          x.data_ptr<float>() + (sample * x.size(1) + channel) * pixels};
}

cv::Mat box_mean(const cv::Mat& plane, int side_px) {
  cv::Mat mean;
  cv::boxFilter(plane, mean, CV_32F, {side_px, side_px}, {-1, -1}, /*normalize=*/false, cv::BORDER_CONSTANT);
  const std::vector<float> columns = mean_factors(plane.cols, side_px);
  const std::vector<float> rows = mean_factors(plane.rows, side_px);
  for (int v = 0; v < mean.rows; ++v) {
    auto* row = mean.ptr<float>(v);
    const float factor = rows[static_cast<std::size_t>(v)];
    for (int u = 0; u < mean.cols; ++u) row[u] *= columns[static_cast<std::size_t>(u)] * factor;
  }
  return mean;
}

cv::Mat shrink(const cv::Mat& plane, int factor) {
  if (factor == 1) return plane;
  cv::Mat small((plane.rows + factor - 1) / factor, (plane.cols + factor - 1) / factor, CV_32FC1);
  const int whole = plane.cols / factor;
  std::vector<float> sums(static_cast<std::size_t>(plane.cols));
  for (int v = 0; v < small.rows; ++v) {
    const int begin = v * factor, end = std::min(begin + factor, plane.rows);
    std::copy_n(plane.ptr<float>(begin), plane.cols, sums.begin());
    for (int r = begin + 1; r < end; ++r) {
      const auto* row = plane.ptr<float>(r);
      for (int u = 0; u < plane.cols; ++u) sums[static_cast<std::size_t>(u)] += row[u];
    }
    auto* out = small.ptr<float>(v);
    for (int u = 0; u < small.cols; ++u) {
      const int first = u * factor, count = u < whole ? factor : plane.cols - first;
      float sum = 0;
      for (int i = first; i < first + count; ++i) sum += sums[static_cast<std::size_t>(i)];
      out[u] = sum / static_cast<float>(count * (end - begin));
    }
  }
  return small;
}

}  // namespace alight
