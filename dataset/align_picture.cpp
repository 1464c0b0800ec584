#include "dataset/align_picture.hpp"

#include <algorithm>
#include <cstdio>

#include <opencv2/imgproc.hpp>

#include "geometry/frames.hpp"

namespace alight {
namespace {

const cv::Scalar kInk(60, 60, 60);
const cv::Scalar kImages(40, 40, 220);
const cv::Scalar kPoses(200, 110, 30);
constexpr int kMargin_px = 40;

/// Plots into a part of a picture, x and y scaled to what is drawn.
class Panel {
 public:
  Panel(cv::Mat picture, const std::string& title, double x_min, double x_max, double y_min, double y_max)
      : picture_(std::move(picture)), x_min_(x_min), x_max_(x_max), y_min_(y_min), y_max_(y_max) {
    cv::rectangle(picture_, {kMargin_px, kMargin_px},
                  {picture_.cols - kMargin_px, picture_.rows - kMargin_px}, {200, 200, 200});
    write(title, {kMargin_px, kMargin_px - 12});
  }

  void line(const std::vector<std::pair<double, double>>& points, const cv::Scalar& colour) {
    for (std::size_t i = 1; i < points.size(); ++i)
      cv::line(picture_, at(points[i - 1]), at(points[i]), colour, 1, cv::LINE_AA);
  }
  void mark(double x, const cv::Scalar& colour) {
    cv::line(picture_, at({x, y_min_}), at({x, y_max_}), colour, 1, cv::LINE_AA);
  }
  void write(const std::string& text, const cv::Point& where, const cv::Scalar& colour = kInk) {
    cv::putText(picture_, text, where, cv::FONT_HERSHEY_SIMPLEX, 0.45, colour, 1, cv::LINE_AA);
  }
  void label_x(const std::string& from, const std::string& to) {
    write(from, {kMargin_px, picture_.rows - kMargin_px + 18});
    write(to, {picture_.cols - kMargin_px - 60, picture_.rows - kMargin_px + 18});
  }

 private:
  cv::Point at(const std::pair<double, double>& p) const {
    const double x = (p.first - x_min_) / std::max(x_max_ - x_min_, 1e-12);
    const double y = (p.second - y_min_) / std::max(y_max_ - y_min_, 1e-12);
    return {static_cast<int>(kMargin_px + x * (picture_.cols - 2 * kMargin_px)),
            static_cast<int>(picture_.rows - kMargin_px - y * (picture_.rows - 2 * kMargin_px))};
  }

  cv::Mat picture_;
  double x_min_, x_max_, y_min_, y_max_;
};

std::string text(const char* format, double a, double b = 0) {
  char buffer[120];
  std::snprintf(buffer, sizeof(buffer), format, a, b);
  return buffer;
}

void draw_scores(const cv::Mat& picture, const std::string& title, const ClockOffset& clock) {
  if (clock.scores.empty()) {
    Panel(picture, title + ": cannot be told", 0, 1, 0, 1);
    return;
  }
  const auto [low, high] =
      std::minmax_element(clock.scores.begin(), clock.scores.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; });
  Panel panel(picture,
              title + (clock.told ? text(": %+.1f +- %.1f ms", 1e3 * clock.offset_s, 1e3 * clock.sigma_s)
                                  : ": cannot be told"),
              clock.scores.front().first, clock.scores.back().first, low->second, high->second);
  panel.line(clock.scores, kInk);
  if (clock.told) panel.mark(clock.offset_s, kImages);
  panel.label_x(text("%+.0f ms", 1e3 * clock.scores.front().first),
                text("%+.0f ms", 1e3 * clock.scores.back().first));
}

/// The axis about which the camera turned most.
void draw_turns(const cv::Mat& picture, const std::vector<ViewTurn>& turns) {
  if (turns.empty()) {
    Panel(picture, "no image was followed to the next", 0, 1, 0, 1);
    return;
  }
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const ViewTurn& turn : turns) squares += turn.posed_rad.cwiseAbs2();
  int axis = 0;
  squares.maxCoeff(&axis);
  std::vector<std::pair<double, double>> seen;
  std::vector<std::pair<double, double>> posed;
  double largest = 1e-6;
  for (const ViewTurn& turn : turns) {
    seen.emplace_back(turn.t_s, to_degrees(turn.seen_rad[axis]));
    posed.emplace_back(turn.t_s, to_degrees(turn.posed_rad[axis]));
    largest = std::max({largest, std::abs(seen.back().second), std::abs(posed.back().second)});
  }
  Panel panel(picture,
              text("turn between images, up to %.2f deg, about the camera's ", largest) +
                  std::string(1, "xyz"[axis]) + ":",
              0, turns.back().t_s, -largest, largest);
  panel.line(posed, kPoses);
  panel.line(seen, kImages);
  panel.write("by the poses", {760, kMargin_px - 12}, kPoses);
  panel.write("by the images", {900, kMargin_px - 12}, kImages);
  panel.label_x("0 s", text("%.0f s", turns.back().t_s));
}

}  // namespace

cv::Mat draw_clock_alignment(const ClockAlignment& alignment) {
  constexpr int kWidth_px = 1200;
  constexpr int kHeight_px = 320;
  cv::Mat picture(2 * kHeight_px, kWidth_px, CV_8UC3, cv::Scalar(255, 255, 255));
  draw_scores(picture({0, 0, kWidth_px / 2, kHeight_px}), "camera's clock, turns left over",
              alignment.camera);
  draw_scores(picture({kWidth_px / 2, 0, kWidth_px / 2, kHeight_px}), "LiDAR's clock, edges on edges",
              alignment.lidar);
  draw_turns(picture({0, kHeight_px, kWidth_px, kHeight_px}), alignment.turns);
  return picture;
}

}  // namespace alight
