#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace alight {

/// Charts are drawn at this many times their final size and then reduced, which gives smooth letters and lines.
/// All lengths in this header are in the larger pixels.
constexpr int kChartOversampling = 2;

/// A line of a chart.
struct Curve {
  cv::Scalar color_bgr;
  std::vector<cv::Point2d> points;  ///< in the data's units; a y that is not finite leaves a gap
};

/// One chart: axes, curves and words.
struct Chart {
  std::string title;
  std::string x_title;
  bool logarithmic = false;  ///< y axis; where the data spans more than a factor of five it is so anyway
  std::vector<Curve> curves;

  /// Whether there is any point to draw.
  bool empty() const;
};

/// Draws axes, grid, ticks and curves. x ticks are whole numbers. A y axis is logarithmic only where all of y is
/// greater than zero. @param canvas CV_8UC3 @param area outer rectangle in it, labels included
/// @throws std::invalid_argument if the chart is empty
void draw_chart(cv::Mat& canvas, const cv::Rect& area, const Chart& chart);

/// One entry of a legend.
struct LegendEntry {
  std::string name;
  cv::Scalar color_bgr;
};

/// Draws entries from left to right, in as many lines as they need; a name that is wider than the area is cut.
/// @param canvas CV_8UC3, or null to measure alone @returns the height used, pixels
int draw_legend(cv::Mat* canvas, const cv::Rect& area, const std::vector<LegendEntry>& entries);

}  // namespace alight
