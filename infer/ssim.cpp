#include "infer/ssim.hpp"

#include <stdexcept>

#include <opencv2/imgproc.hpp>

namespace alight {
namespace {

constexpr float kC1 = 0.01F * 0.01F;
constexpr float kC2 = 0.03F * 0.03F;

cv::Mat box(const cv::Mat& image) {
  cv::Mat mean;
  cv::boxFilter(image, mean, CV_32F, {3, 3}, {-1, -1}, true, cv::BORDER_REFLECT_101);
  return mean;
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
  const cv::Mat mean_a = box(a);
  const cv::Mat mean_b = box(b);
  const cv::Mat mean_aa = box(a.mul(a));
  const cv::Mat mean_bb = box(b.mul(b));
  const cv::Mat mean_ab = box(a.mul(b));
  cv::Mat ssim(a.size(), CV_32FC1);
  for (int v = 0; v < ssim.rows; ++v) {
    const float* ma = mean_a.ptr<float>(v);
    const float* mb = mean_b.ptr<float>(v);
    const float* maa = mean_aa.ptr<float>(v);
    const float* mbb = mean_bb.ptr<float>(v);
    const float* mab = mean_ab.ptr<float>(v);
    float* out = ssim.ptr<float>(v);
    for (int u = 0; u < ssim.cols; ++u) {
      const float product = ma[u] * mb[u];
      const float squares = ma[u] * ma[u] + mb[u] * mb[u];
      const float covariance = mab[u] - product;
      const float variances = maa[u] + mbb[u] - squares;
      out[u] = (2 * product + kC1) * (2 * covariance + kC2) / ((squares + kC1) * (variances + kC2));
    }
  }
  return ssim;
}

}  // namespace alight
