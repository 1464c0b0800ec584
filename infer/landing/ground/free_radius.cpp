#include "infer/landing/ground/free_radius.hpp"

#include <opencv2/imgproc.hpp>

namespace alight {

cv::Mat free_radius(const cv::Mat& safe, double side) {
  cv::Mat framed;
  cv::copyMakeBorder(safe, framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat distance;  // between centres
  cv::distanceTransform(framed, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Mat radius = (distance(cv::Rect({1, 1}, safe.size())) - 0.5) * side;
  return cv::max(radius, 0.0);
}

}  // namespace alight
