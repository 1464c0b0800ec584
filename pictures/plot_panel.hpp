#pragma once

#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

namespace alight {

using PlotPoints = std::vector<std::pair<double, double>>;

/// Plots into a part of a picture: a frame, a title above, the ends of the axes below it.
class PlotPanel {
 public:
  struct Range {
    double from = 0;
    double to = 1;
  };
  /// @param picture CV_8UC3, drawn into
  PlotPanel(cv::Mat picture, const std::string& title, Range x, Range y);

  void line(const PlotPoints& points, const cv::Scalar& colour);
  /// A bar from the bottom to `y` over [from, to].
  void bar(Range over, double y, const cv::Scalar& colour);
  /// A vertical line.
  void mark(double x, const cv::Scalar& colour);
  void label_x(const std::string& from, const std::string& to);
  void label_y(const std::string& top);
  /// Words of a colour at the right end of the title's line, one left of the other.
  void legend(const std::string& words, const cv::Scalar& colour);
  /// An image that fills the frame, its shape kept.
  void image(const cv::Mat& bgr);

 private:
  cv::Point at(double x, double y) const;
  void write(const std::string& text, const cv::Point& where, const cv::Scalar& colour);

  cv::Mat picture_;
  Range x_;
  Range y_;
  int legend_px_;
};

}  // namespace alight
