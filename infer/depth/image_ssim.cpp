#include "infer/depth/image_ssim.hpp"

#include <stdexcept>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

#include "geometry/wide_loops.hpp"

namespace alight {
namespace {

constexpr float kC1 = 0.01F * 0.01F;
constexpr float kC2 = 0.03F * 0.03F;

/// Sums over the rows of a window, a number a column.
struct ColumnSums {
  explicit ColumnSums(int width) : a(width), b(width), aa(width), bb(width), ab(width) {}
  Eigen::ArrayXf a, b, aa, bb, ab;
};

/// Windows over the border see its reflection.
int reflect(int at, int length) { return cv::borderInterpolate(at, length, cv::BORDER_REFLECT_101); }

float similarity(float mean_a, float mean_b, float mean_aa, float mean_bb, float mean_ab) {
  const float product = mean_a * mean_b;
  const float squares = mean_a * mean_a + mean_b * mean_b;
  const float covariance = mean_ab - product;
  const float variances = mean_aa + mean_bb - squares;
  return (2 * product + kC1) * (2 * covariance + kC2) / ((squares + kC1) * (variances + kC2));
}

ALIGHT_WIDE_LOOPS void sum_columns(const float* const* a_rows, const float* const* b_rows, int width,
                                   float* __restrict a, float* __restrict b, float* __restrict aa,
                                   float* __restrict bb, float* __restrict ab) {
  const float *a0 = a_rows[0], *a1 = a_rows[1], *a2 = a_rows[2];
  const float *b0 = b_rows[0], *b1 = b_rows[1], *b2 = b_rows[2];
  for (int u = 0; u < width; ++u) {
    a[u] = a0[u] + a1[u] + a2[u];
    b[u] = b0[u] + b1[u] + b2[u];
    aa[u] = a0[u] * a0[u] + a1[u] * a1[u] + a2[u] * a2[u];
    bb[u] = b0[u] * b0[u] + b1[u] * b1[u] + b2[u] * b2[u];
    ab[u] = a0[u] * b0[u] + a1[u] * b1[u] + a2[u] * b2[u];
  }
}

/// All but the first and last column.
ALIGHT_WIDE_LOOPS void similarity_of_row(const float* a, const float* b, const float* aa, const float* bb,
                                         const float* ab, int width, float* __restrict out) {
  constexpr float kMean = 1.0F / 9;
  for (int u = 1; u + 1 < width; ++u) {
    out[u] = similarity(kMean * (a[u - 1] + a[u] + a[u + 1]), kMean * (b[u - 1] + b[u] + b[u + 1]),
                        kMean * (aa[u - 1] + aa[u] + aa[u + 1]), kMean * (bb[u - 1] + bb[u] + bb[u + 1]),
                        kMean * (ab[u - 1] + ab[u] + ab[u + 1]));
  }
}

float similarity_at(const ColumnSums& sums, int u, int width) {
  constexpr float kMean = 1.0F / 9;
  const int before = reflect(u - 1, width), after = reflect(u + 1, width);
  const auto mean = [&](const Eigen::ArrayXf& x) { return kMean * (x[before] + x[u] + x[after]); };
  return similarity(mean(sums.a), mean(sums.b), mean(sums.aa), mean(sums.bb), mean(sums.ab));
}

}  // namespace

cv::Mat to_luminance(const cv::Mat& image) {
  cv::Mat grey;
  if (image.type() == CV_8UC3) {
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  } else if (image.type() == CV_8UC1) {
    grey = image;
  } else {
    throw std::invalid_argument("to_luminance: image must be CV_8UC1 or CV_8UC3");
  }
  cv::Mat luminance;
  grey.convertTo(luminance, CV_32F, 1.0 / 255.0);
  return luminance;
}

cv::Mat ssim_map(const cv::Mat& a, const cv::Mat& b) {
  if (a.type() != CV_32FC1 || b.type() != CV_32FC1 || a.size() != b.size()) {
    throw std::invalid_argument("ssim_map: images must be CV_32FC1 of one size");
  }
  cv::Mat ssim(a.size(), CV_32FC1);
  ColumnSums sums(a.cols);
  for (int v = 0; v < a.rows; ++v) {
    const int rows[] = {reflect(v - 1, a.rows), v, reflect(v + 1, a.rows)};
    const float* const a_rows[] = {a.ptr<float>(rows[0]), a.ptr<float>(rows[1]), a.ptr<float>(rows[2])};
    const float* const b_rows[] = {b.ptr<float>(rows[0]), b.ptr<float>(rows[1]), b.ptr<float>(rows[2])};
    sum_columns(a_rows, b_rows, a.cols, sums.a.data(), sums.b.data(), sums.aa.data(), sums.bb.data(),
                sums.ab.data());
    auto* const out = ssim.ptr<float>(v);
    similarity_of_row(sums.a.data(), sums.b.data(), sums.aa.data(), sums.bb.data(), sums.ab.data(), a.cols,
                      out);
    for (const int u : {0, a.cols - 1}) out[u] = similarity_at(sums, u, a.cols);
  }
  return ssim;
}

}  // namespace alight
