#include "calibrate/clocks/edge_agreement.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace alight {
namespace {

constexpr double kUnit = 64;  // of edge_strength

double at(const cv::Mat& strength, const Eigen::Vector2d& pixel) {
  const double u = std::clamp(pixel.x(), 0.0, strength.cols - 1.001);
  const double v = std::clamp(pixel.y(), 0.0, strength.rows - 1.001);
  const int left = static_cast<int>(u);
  const int top = static_cast<int>(v);
  const double right_share = u - left;
  const double lower_share = v - top;
  const auto* upper = strength.ptr<std::uint8_t>(top) + left;
  const auto* lower = strength.ptr<std::uint8_t>(top + 1) + left;
  return (1 - lower_share) * ((1 - right_share) * upper[0] + right_share * upper[1]) +
         lower_share * ((1 - right_share) * lower[0] + right_share * lower[1]);
}

}  // namespace

cv::Mat edge_strength(const cv::Mat& grey) {
  constexpr double kSmooth_px = 1.0;
  constexpr int kAround_px = 41;
  constexpr double kNoise = 1.0;  // grey levels a pixel: gradients that small are the sensor's noise
  cv::Mat smooth;
  grey.convertTo(smooth, CV_32F);
  cv::GaussianBlur(smooth, smooth, {}, kSmooth_px);
  cv::Mat du;
  cv::Mat dv;
  cv::Sobel(smooth, du, CV_32F, 1, 0, 3, 1.0 / 8);
  cv::Sobel(smooth, dv, CV_32F, 0, 1, 3, 1.0 / 8);
  cv::Mat gradient;
  cv::magnitude(du, dv, gradient);
  cv::Mat around;
  cv::blur(gradient, around, {kAround_px, kAround_px});
  around += kNoise;
  cv::Mat strength;
  cv::divide(gradient, around, strength, kUnit, CV_8U);
  return strength;
}

EdgeAgreement::EdgeAgreement(const PinholeIntrinsics& intrinsics, int margin_px)
    : intrinsics_(intrinsics), margin_px_(margin_px) {}

void EdgeAgreement::add_view(const cv::Mat& strength, const std::vector<SeenPoint>& points) {
  View view{strength, {}};
  for (const SeenPoint& point : points) {
    const Eigen::Vector3d p = point.T_view_own * point.p_own;
    if (p.z() <= 0) continue;
    const Eigen::Vector2d pixel = intrinsics_.project(p);
    if (pixel.minCoeff() < margin_px_ || pixel.x() > strength.cols - 1 - margin_px_ ||
        pixel.y() > strength.rows - 1 - margin_px_)
      continue;
    view.points.push_back(point);
  }
  points_ += view.points.size();
  views_.push_back(std::move(view));
}

std::vector<double> EdgeAgreement::scores(const Eigen::Isometry3d& motion, std::size_t every_nth) const {
  std::vector<double> result;
  std::size_t count = 0;
  for (const View& view : views_) {
    double sum = 0;
    for (std::size_t i = 0; i < view.points.size(); i += every_nth) {
      const SeenPoint& point = view.points[i];
      const Eigen::Vector3d p = point.T_view_own * (motion * point.p_own);
      sum += at(view.strength, intrinsics_.project(p));
      ++count;
    }
    result.push_back(sum / kUnit);
  }
  for (double& score : result) score /= static_cast<double>(std::max<std::size_t>(1, count));
  return result;
}

std::vector<Eigen::Vector2d> EdgeAgreement::pixels(std::size_t view, const Eigen::Isometry3d& motion) const {
  std::vector<Eigen::Vector2d> result;
  for (const SeenPoint& point : views_[view].points)
    result.push_back(intrinsics_.project(point.T_view_own * (motion * point.p_own)));
  return result;
}

}  // namespace alight
