#include "calibrate/stereo/stereo_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "geometry/rig/stereo_rectification.hpp"

namespace alight {

std::string format_stereo_report(const StereoCalibration& calibration) {
  const auto used = std::count_if(calibration.views.begin(), calibration.views.end(),
                                  [](const StereoView& view) { return view.used; });
  std::string report = fmt::format("RMS {:.3f} px over {} views\n", calibration.rms_px, used);
  report += fmt::format("epipolar error after rectification: RMS {:.3f} px, largest {:.2f} px\n",
                        calibration.epipolar_rms_px, calibration.epipolar_max_px);
  report += fmt::format("image covered by corners: left {:.0f} %, right {:.0f} %\n\n",
                        100 * calibration.coverage_left, 100 * calibration.coverage_right);
  report += fmt::format("{:22} {:>12} {:>10}\n", "parameter", "value", "1 sigma");
  for (const Estimate& e : calibration.estimates)
    report += fmt::format("{:22} {:>12.5f} {:>10.5f}\n", e.name, e.value, e.sigma);
  report += fmt::format("\n{:28} {:>10} {:>10}\n", "view", "left [px]", "right [px]");
  for (const StereoView& view : calibration.views) {
    if (view.used)
      report += fmt::format("{:28} {:>10.3f} {:>10.3f}\n", view.name, view.rms_left_px, view.rms_right_px);
  }
  for (const StereoView& view : calibration.views) {
    if (!view.used) report += view.name + " left out: " + view.reason + "\n";
  }
  return report;
}

cv::Mat draw_rectified(const StereoCalibration& calibration, const StereoView& view) {
  constexpr int kLineDistance_px = 24;
  const StereoRectifier rectifier(calibration.rig);
  cv::Mat both;
  cv::hconcat(rectifier.rectify_left(view.left), rectifier.rectify_right(view.right), both);
  cv::Mat picture;
  cv::cvtColor(both, picture, cv::COLOR_GRAY2BGR);
  for (int v = kLineDistance_px / 2; v < picture.rows; v += kLineDistance_px) {
    const bool even = v / kLineDistance_px % 2 == 0;
    cv::line(picture, {0, v}, {picture.cols - 1, v},
             even ? cv::Scalar(80, 220, 80) : cv::Scalar(60, 160, 255));
  }
  return picture;
}

}  // namespace alight
