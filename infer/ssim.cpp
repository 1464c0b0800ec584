#include "infer/ssim.hpp"

#include <stdexcept>

#include <Eigen/Core>
#include <opencv2/imgproc.hpp>

namespace alight {
namespace {

constexpr float kC1 = 0.01F * 0.01F;
constexpr float kC2 = 0.03F * 0.03F;

/// Sums over columns of three rows; windows over the border see its reflection.
struct WindowRow {
  explicit WindowRow(int width) : a(width), b(width), aa(width), bb(width), ab(width) {}
  Eigen::ArrayXf a, b, aa, bb, ab;  // [W]
};

int reflect(int at, int length) { return cv::borderInterpolate(at, length, cv::BORDER_REFLECT_101); }

void add_row(const float* a, const float* b, WindowRow& sums) {
  for (Eigen::Index u = 0; u < sums.a.size(); ++u) {
    sums.a[u] += a[u];
    sums.b[u] += b[u];
    sums.aa[u] += a[u] * a[u];
    sums.bb[u] += b[u] * b[u];
    sums.ab[u] += a[u] * b[u];
  }
}

/// @param before, here, after columns of the window
float similarity(const WindowRow& sums, Eigen::Index before, Eigen::Index here, Eigen::Index after) {
  constexpr float kMean = 1.0F / 9;
  const auto mean = [&](const Eigen::ArrayXf& x) { return kMean * (x[before] + x[here] + x[after]); };
  const float a = mean(sums.a), b = mean(sums.b);
  const float product = a * b;
  const float squares = a * a + b * b;
  const float covariance = mean(sums.ab) - product;
  const float variances = mean(sums.aa) + mean(sums.bb) - squares;
  return (2 * product + kC1) * (2 * covariance + kC2) / ((squares + kC1) * (variances + kC2));
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
  for (int v = 0; v < a.rows; ++v) {
    WindowRow sums(a.cols);
    for (Eigen::ArrayXf* sum : {&sums.a, &sums.b, &sums.aa, &sums.bb, &sums.ab}) sum->setZero();
    for (const int row : {reflect(v - 1, a.rows), v, reflect(v + 1, a.rows)})
      add_row(a.ptr<float>(row), b.ptr<float>(row), sums);
    auto* out = ssim.ptr<float>(v);
    for (int u = 1; u + 1 < a.cols; ++u) out[u] = similarity(sums, u - 1, u, u + 1);
    for (const int u : {0, a.cols - 1})
      out[u] = similarity(sums, reflect(u - 1, a.cols), u, reflect(u + 1, a.cols));
  }
  return ssim;
}

}  // namespace alight
