#include "pictures/plot_panel.hpp"

#include <algorithm>

#include <opencv2/imgproc.hpp>

namespace alight {
namespace {

const cv::Scalar kFrameInk(60, 60, 60);
constexpr int kMargin_px = 40;
constexpr double kPanelFont = 0.45;

cv::Size size_of(const std::string& text) {
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kPanelFont, 1, nullptr);
}

double share(double value, const PlotPanel::Range& range) {
  return (value - range.from) / std::max(range.to - range.from, 1e-12);
}

}  // namespace

PlotPanel::PlotPanel(cv::Mat picture, const std::string& title, Range x, Range y)
    : picture_(std::move(picture)), x_(x), y_(y), legend_px_(picture_.cols - kMargin_px) {
  cv::rectangle(picture_, {kMargin_px, kMargin_px}, {picture_.cols - kMargin_px, picture_.rows - kMargin_px},
                {200, 200, 200});
  write(title, {kMargin_px, kMargin_px - 12}, kFrameInk);
}

void PlotPanel::line(const PlotPoints& points, const cv::Scalar& colour) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    cv::line(picture_, at(points[i - 1].first, points[i - 1].second), at(points[i].first, points[i].second),
             colour, 1, cv::LINE_AA);
  }
}

void PlotPanel::bar(Range over, double y, const cv::Scalar& colour) {
  cv::rectangle(picture_, at(over.from, y) + cv::Point(1, 0), at(over.to, y_.from) - cv::Point(1, 0), colour,
                cv::FILLED);
}

void PlotPanel::mark(double x, const cv::Scalar& colour) {
  cv::line(picture_, at(x, y_.from), at(x, y_.to), colour, 1, cv::LINE_AA);
}

void PlotPanel::label_x(const std::string& from, const std::string& to) {
  const int below_px = picture_.rows - kMargin_px + 18;
  write(from, {kMargin_px, below_px}, kFrameInk);
  write(to, {picture_.cols - kMargin_px - size_of(to).width, below_px}, kFrameInk);
}

void PlotPanel::label_y(const std::string& top) { write(top, {kMargin_px + 6, kMargin_px + 16}, kFrameInk); }

void PlotPanel::legend(const std::string& words, const cv::Scalar& colour) {
  constexpr int kGap_px = 16;
  write(words, {legend_px_ - size_of(words).width, kMargin_px - 12}, colour);
  legend_px_ -= size_of(words).width + kGap_px;
}

void PlotPanel::image(const cv::Mat& bgr) {
  const cv::Size room(picture_.cols - 2 * kMargin_px - 2, picture_.rows - 2 * kMargin_px - 2);
  const double scale =
      std::min(static_cast<double>(room.width) / bgr.cols, static_cast<double>(room.height) / bgr.rows);
  cv::Mat scaled;
  cv::resize(bgr, scaled, {}, scale, scale, scale < 1 ? cv::INTER_AREA : cv::INTER_NEAREST);
  scaled.copyTo(picture_({kMargin_px + 1 + (room.width - scaled.cols) / 2,
                          kMargin_px + 1 + (room.height - scaled.rows) / 2, scaled.cols, scaled.rows}));
}

cv::Point PlotPanel::at(double x, double y) const {
  return {static_cast<int>(kMargin_px + share(x, x_) * (picture_.cols - 2 * kMargin_px)),
          static_cast<int>(picture_.rows - kMargin_px - share(y, y_) * (picture_.rows - 2 * kMargin_px))};
}

void PlotPanel::write(const std::string& text, const cv::Point& where, const cv::Scalar& colour) {
  cv::putText(picture_, text, where, cv::FONT_HERSHEY_SIMPLEX, kPanelFont, colour, 1, cv::LINE_AA);
}

}  // namespace alight
