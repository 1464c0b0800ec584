#include "calibrate/clocks/align_picture.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "geometry/frames.hpp"
#include "pictures/plot_panel.hpp"

namespace alight {
namespace {

const cv::Scalar kScoreInk(60, 60, 60);
const cv::Scalar kImages(40, 40, 220);
const cv::Scalar kPoses(200, 110, 30);

void draw_scores(const cv::Mat& picture, const std::string& title, const ClockOffset& clock) {
  if (clock.scores.empty()) {
    PlotPanel(picture, title + ": cannot be told", {}, {});
    return;
  }
  const auto [low, high] =
      std::minmax_element(clock.scores.begin(), clock.scores.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; });
  PlotPanel panel(
      picture,
      title + (clock.told ? fmt::format(": {:+.1f} +- {:.1f} ms", 1e3 * clock.offset_s, 1e3 * clock.sigma_s)
                          : ": cannot be told"),
      {clock.scores.front().first, clock.scores.back().first}, {low->second, high->second});
  panel.line(clock.scores, kScoreInk);
  if (clock.told) panel.mark(clock.offset_s, kImages);
  panel.label_x(fmt::format("{:+.0f} ms", 1e3 * clock.scores.front().first),
                fmt::format("{:+.0f} ms", 1e3 * clock.scores.back().first));
}

/// The axis about which the camera turned most.
void draw_turns(const cv::Mat& picture, const std::vector<ViewTurn>& turns) {
  if (turns.empty()) {
    PlotPanel(picture, "no image was followed to the next", {}, {});
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
  PlotPanel panel(picture,
                  fmt::format("turn between images, up to {:.2f} deg, about the camera's ", largest) +
                      std::string(1, "xyz"[axis]),
                  {0, turns.back().t_s}, {-largest, largest});
  panel.line(posed, kPoses);
  panel.line(seen, kImages);
  panel.legend("by the images", kImages);
  panel.legend("by the poses", kPoses);
  panel.label_x("0 s", fmt::format("{:.0f} s", turns.back().t_s));
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
