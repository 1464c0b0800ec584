#include "pictures/chart.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

#include "pictures/chart_axis.hpp"

namespace alight {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kTitleSize = 1.15;
constexpr double kLabelSize = 0.95;
constexpr int kLetterStroke_px = 2;
constexpr int kCurveStroke_px = 4;
const cv::Scalar kInk(40, 40, 40);
const cv::Scalar kGrid(225, 225, 225);

cv::Size text_size(const std::string& text, double size) {
  int below_baseline_px = 0;
  return cv::getTextSize(text, kFont, size, kLetterStroke_px, &below_baseline_px);
}

void draw_text(cv::Mat& canvas, const std::string& text, const cv::Point& bottom_left, double size) {
  cv::putText(canvas, text, bottom_left, kFont, size, kInk, kLetterStroke_px, cv::LINE_AA);
}

/// The axes and where they lie in the picture.
struct Frame {
  cv::Rect plot;
  ChartAxis x, y;

  cv::Point at(const cv::Point2d& p) const {
    return {plot.x + cvRound(x.share(p.x) * plot.width),
            plot.y + plot.height - cvRound(y.share(p.y) * plot.height)};
  }
};

bool drawable(const cv::Point2d& p) { return std::isfinite(p.x) && std::isfinite(p.y); }

/// Smallest and largest coordinates of all points that can be drawn.
void find_limits(const Chart& chart, cv::Point2d& min, cv::Point2d& max) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  min = {kFar, kFar};
  max = {-kFar, -kFar};
  for (const Curve& curve : chart.curves) {
    for (const cv::Point2d& p : curve.points) {
      if (!drawable(p)) continue;
      min = {std::min(min.x, p.x), std::min(min.y, p.y)};
      max = {std::max(max.x, p.x), std::max(max.y, p.y)};
    }
  }
}

ChartAxis y_axis(double min, double max, bool logarithmic) {
  constexpr double kManyFold = 5;
  if (min > 0 && (logarithmic || max > kManyFold * min)) return logarithmic_axis(min, max);
  const double widen = 0.05 * (max - min);
  return linear_axis(min >= 0 ? std::max(min - widen, 0.0) : min - widen, max + widen);
}

Frame make_frame(const cv::Rect& area, const Chart& chart) {
  cv::Point2d min, max;
  find_limits(chart, min, max);
  constexpr int kLeft = 150, kRight = 40, kTop = 70, kBottom = 100;  // room for labels
  return {{area.x + kLeft, area.y + kTop, area.width - kLeft - kRight, area.height - kTop - kBottom},
          linear_axis(min.x, max.x, /*whole=*/true),
          y_axis(min.y, max.y, chart.logarithmic)};
}

void draw_axes(cv::Mat& canvas, const Frame& frame) {
  constexpr int kGap = 14;
  for (const AxisTick& tick : frame.x.ticks) {
    const cv::Point foot = frame.at({tick.value, frame.y.min});
    const cv::Size size = text_size(tick.label, kLabelSize);
    cv::line(canvas, foot, {foot.x, frame.plot.y}, kGrid, 2);
    draw_text(canvas, tick.label, {foot.x - size.width / 2, foot.y + kGap + size.height}, kLabelSize);
  }
  for (const AxisTick& tick : frame.y.ticks) {
    const cv::Point foot = frame.at({frame.x.min, tick.value});
    const cv::Size size = text_size(tick.label, kLabelSize);
    cv::line(canvas, foot, {foot.x + frame.plot.width, foot.y}, kGrid, 2);
    draw_text(canvas, tick.label, {foot.x - kGap - size.width, foot.y + size.height / 2}, kLabelSize);
  }
  cv::rectangle(canvas, frame.plot, kInk, 2);
}

void draw_titles(cv::Mat& canvas, const Frame& frame, const Chart& chart) {
  draw_text(canvas, chart.title, {frame.plot.x, frame.plot.y - 20}, kTitleSize);
  const cv::Size size = text_size(chart.x_title, kLabelSize);
  draw_text(canvas, chart.x_title,
            {frame.plot.x + (frame.plot.width - size.width) / 2, frame.plot.y + frame.plot.height + 82},
            kLabelSize);
}

void draw_curve(cv::Mat& canvas, const Frame& frame, const Curve& curve) {
  constexpr std::size_t kFewPoints =
      40;  // each gets a dot, without which a run of one epoch would not be seen
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    if (!drawable(curve.points[i])) continue;
    const cv::Point here = frame.at(curve.points[i]);
    if (i > 0 && drawable(curve.points[i - 1])) {
      cv::line(canvas, frame.at(curve.points[i - 1]), here, curve.color_bgr, kCurveStroke_px, cv::LINE_AA);
    }
    if (curve.points.size() <= kFewPoints) cv::circle(canvas, here, 7, curve.color_bgr, -1, cv::LINE_AA);
  }
}

std::string cut_to(std::string name, int width_px) {
  if (text_size(name, kTitleSize).width <= width_px) return name;
  while (!name.empty() && text_size(name + "...", kTitleSize).width > width_px) name.pop_back();
  return name + "...";
}

}  // namespace

bool Chart::empty() const {
  return std::none_of(curves.begin(), curves.end(),
                      [](const Curve& c) { return std::any_of(c.points.begin(), c.points.end(), drawable); });
}

void draw_chart(cv::Mat& canvas, const cv::Rect& area, const Chart& chart) {
  if (chart.empty()) throw std::invalid_argument("draw_chart: nothing to draw in " + chart.title);
  const Frame frame = make_frame(area, chart);
  draw_axes(canvas, frame);
  for (const Curve& curve : chart.curves) draw_curve(canvas, frame, curve);
  draw_titles(canvas, frame, chart);
}

int draw_legend(cv::Mat* canvas, const cv::Rect& area, const std::vector<LegendEntry>& entries) {
  constexpr int kStroke = 80, kGap = 20, kBetween = 70, kLine = 60;
  cv::Point at(area.x, area.y + kLine);
  for (const LegendEntry& entry : entries) {
    const std::string name = cut_to(entry.name, area.width - kStroke - kGap);
    const cv::Size size = text_size(name, kTitleSize);
    const int width = kStroke + kGap + size.width;
    if (at.x > area.x && at.x + width > area.x + area.width) at = {area.x, at.y + kLine};
    if (canvas != nullptr) {
      const int middle = at.y - size.height / 2;
      cv::line(*canvas, {at.x, middle}, {at.x + kStroke, middle}, entry.color_bgr, 2 * kCurveStroke_px,
               cv::LINE_AA);
      draw_text(*canvas, name, {at.x + kStroke + kGap, at.y}, kTitleSize);
    }
    at.x += width + kBetween;
  }
  return at.y + kGap - area.y;
}

}  // namespace alight
