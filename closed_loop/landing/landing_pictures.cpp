#include "closed_loop/landing/landing_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <opencv2/imgproc.hpp>

#include "geometry/frames.hpp"

namespace alight::closed_loop {
namespace {

const cv::Scalar kInk(40, 40, 40);
const cv::Scalar kGrid(215, 215, 215);
const cv::Scalar kShadow(170, 170, 170);

/// BGR.
cv::Scalar colour(MissionState state) {
  switch (state) {
    case MissionState::kManual:
      return {120, 120, 120};
    case MissionState::kSelect:
      return {200, 120, 0};
    case MissionState::kFlyAbove:
      return {200, 0, 160};
    case MissionState::kDescend:
      return {0, 140, 255};
    case MissionState::kWander:
      return {190, 190, 0};
    case MissionState::kConfirm:
      return {0, 200, 230};
    case MissionState::kFinalDescent:
      return {0, 90, 0};
    case MissionState::kTouchdown:
      return {0, 160, 0};
    case MissionState::kClimbAway:
      return {0, 0, 220};
    case MissionState::kHold:
      return {0, 0, 130};
    case MissionState::kGivenUp:
      return {0, 0, 0};
  }
  return kInk;
}

void put(cv::Mat& image, const std::string& text, cv::Point at, const cv::Scalar& ink = kInk,
         double size = 0.45) {
  cv::putText(image, text, at, cv::FONT_HERSHEY_SIMPLEX, size, ink, 1, cv::LINE_AA);
}

/// So that text on it can be read.
void lighten(cv::Mat& image, const cv::Rect& where) {
  cv::Mat panel = image(where & cv::Rect({0, 0}, image.size()));
  panel.convertTo(panel, -1, 0.15, 0.85 * 255);
}

void put_legend(cv::Mat& image, const FlownLanding& flown, cv::Point at) {
  std::set<MissionState> seen;
  for (const TrackPoint& point : flown.track) seen.insert(point.state);
  lighten(image, {at.x - 8, at.y - 12, 150, 19 * static_cast<int>(seen.size()) + 8});
  for (const MissionState state : kMissionStates) {
    if (seen.count(state) == 0) continue;
    cv::line(image, at, at + cv::Point(22, 0), colour(state), 3, cv::LINE_AA);
    put(image, name(state), at + cv::Point(30, 4));
    at.y += 19;
  }
}

/// A view from the south-east, parallel projection.
class Axonometry {
 public:
  Axonometry(const Eigen::Vector3d& low, const Eigen::Vector3d& high, cv::Size size) {
    const Eigen::Vector3d span = high - low;
    const double width = span.x() * std::cos(kTurn) + span.y() * std::sin(kTurn);
    const double height = (span.x() * std::sin(kTurn) + span.y() * std::cos(kTurn)) * kTilt + span.z();
    scale_ = std::min((size.width - 180) / width, (size.height - 120) / height);
    origin_ = {0, 0};
    const cv::Point2d middle = raw(0.5 * (low + high));
    origin_ = cv::Point2d(size.width / 2.0, size.height / 2.0 + 10) - middle;
  }
  cv::Point operator()(const Eigen::Vector3d& p) const {
    const cv::Point2d q = raw(p) + origin_;
    return {static_cast<int>(std::lround(q.x)), static_cast<int>(std::lround(q.y))};
  }

 private:
  static constexpr double kTurn = 0.6;
  static constexpr double kTilt = 0.45;
  cv::Point2d raw(const Eigen::Vector3d& p) const {
    const double right = p.x() * std::cos(kTurn) + p.y() * std::sin(kTurn);
    const double away = -p.x() * std::sin(kTurn) + p.y() * std::cos(kTurn);
    return {scale_ * right, -scale_ * (p.z() + kTilt * away)};
  }
  double scale_ = 1;
  cv::Point2d origin_;
};

double ground_below_m(const sim::SurfaceTruth& truth, const Eigen::Vector3d& p) {
  const double z_m = truth.elevation_m(p.x(), p.y());
  return std::isfinite(z_m) ? z_m : 0;
}

double round_down(double value, double step) { return step * std::floor(value / step); }
double round_up(double value, double step) { return step * std::ceil(value / step); }

void draw_box(cv::Mat& image, const Axonometry& view, const Eigen::Vector3d& low, const Eigen::Vector3d& high,
              double step) {
  for (double x = low.x(); x <= high.x() + 1e-6; x += step) {
    cv::line(image, view({x, low.y(), low.z()}), view({x, high.y(), low.z()}), kGrid, 1, cv::LINE_AA);
    cv::line(image, view({x, high.y(), low.z()}), view({x, high.y(), high.z()}), kGrid, 1, cv::LINE_AA);
    put(image, cv::format("%.0f", x), view({x, low.y(), low.z()}) + cv::Point(-8, 18));
  }
  for (double y = low.y(); y <= high.y() + 1e-6; y += step) {
    cv::line(image, view({low.x(), y, low.z()}), view({high.x(), y, low.z()}), kGrid, 1, cv::LINE_AA);
    cv::line(image, view({low.x(), y, low.z()}), view({low.x(), y, high.z()}), kGrid, 1, cv::LINE_AA);
    put(image, cv::format("%.0f", y), view({high.x(), y, low.z()}) + cv::Point(8, 10));
  }
  for (double z = low.z(); z <= high.z() + 1e-6; z += step) {
    cv::line(image, view({low.x(), low.y(), z}), view({low.x(), high.y(), z}), kGrid, 1, cv::LINE_AA);
    cv::line(image, view({low.x(), high.y(), z}), view({high.x(), high.y(), z}), kGrid, 1, cv::LINE_AA);
    put(image, cv::format("%.0f", z), view({low.x(), low.y(), z}) + cv::Point(-28, 4));
  }
  put(image, "east [m]", view({(low.x() + high.x()) / 2, low.y(), low.z()}) + cv::Point(-60, 38));
  put(image, "north [m]", view({high.x(), (low.y() + high.y()) / 2, low.z()}) + cv::Point(30, 28));
  put(image, "up [m]", view({low.x(), low.y(), high.z()}) + cv::Point(-40, -14));
}

}  // namespace

cv::Mat trajectory_picture(const FlownLanding& flown, const sim::SurfaceTruth& truth) {
  cv::Mat image(720, 960, CV_8UC3, cv::Scalar::all(255));
  Eigen::Vector3d low = flown.track.front().p_world;
  Eigen::Vector3d high = low;
  for (const TrackPoint& point : flown.track) {
    low = low.cwiseMin(point.p_world)
              .cwiseMin(Eigen::Vector3d(point.p_world.x(), point.p_world.y(),
                                        ground_below_m(truth, point.p_world)));
    high = high.cwiseMax(point.p_world);
  }
  const double extent = (high - low).maxCoeff();
  const double step = extent > 50 ? 20 : extent > 25 ? 10 : 5;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = round_down(low[axis], step);
    high[axis] = std::max(round_up(high[axis], step), low[axis] + step);
  }
  const Axonometry view(low, high, image.size());
  draw_box(image, view, low, high, step);
  for (std::size_t i = 1; i < flown.track.size(); ++i) {
    Eigen::Vector3d a = flown.track[i - 1].p_world;
    Eigen::Vector3d b = flown.track[i].p_world;
    a.z() = ground_below_m(truth, a);
    b.z() = ground_below_m(truth, b);
    cv::line(image, view(a), view(b), kShadow, 2, cv::LINE_AA);
  }
  for (std::size_t i = 1; i < flown.track.size(); ++i) {
    cv::line(image, view(flown.track[i - 1].p_world), view(flown.track[i].p_world),
             colour(flown.track[i].state), 2, cv::LINE_AA);
  }
  cv::circle(image, view(flown.track.front().p_world), 5, kInk, 1, cv::LINE_AA);
  const bool good = flown.result.outcome == Outcome::kSafe;
  cv::drawMarker(image, view(flown.track.back().p_world),
                 good ? cv::Scalar(0, 160, 0) : cv::Scalar(0, 0, 220), cv::MARKER_TILTED_CROSS, 14, 3);
  put_legend(image, flown, {16, 40});
  put(image,
      cv::format("%s %d: %s after %.1f s", flown.result.look.c_str(), flown.result.seed,
                 name(flown.result.outcome), flown.result.duration_s),
      {16, 20}, kInk, 0.5);
  return image;
}

cv::Mat top_picture(const FlownLanding& flown, const sim::SurfaceTruth& truth, double body_radius_m) {
  constexpr int kSide_px = 792;
  const double half_m = flown.fence_m + 4;
  const double px_per_m = kSide_px / (2 * half_m);
  const auto to_pixel = [&](double x_m, double y_m) {
    return cv::Point(static_cast<int>(std::lround((x_m - flown.fence_middle.x() + half_m) * px_per_m)),
                     static_cast<int>(std::lround((half_m - (y_m - flown.fence_middle.y())) * px_per_m)));
  };
  cv::Mat image(kSide_px, kSide_px, CV_8UC3);
  for (int v = 0; v < kSide_px; ++v) {
    for (int u = 0; u < kSide_px; ++u) {
      const double x_m = flown.fence_middle.x() + u / px_per_m - half_m;
      const double y_m = flown.fence_middle.y() + half_m - v / px_per_m;
      const auto here = truth.ground_at(x_m, y_m);
      const double beside_m = truth.elevation_m(x_m - 0.2, y_m + 0.2);
      if (!here || !std::isfinite(here->elevation_m)) {
        image.at<cv::Vec3b>(v, u) = {0, 0, 0};
        continue;
      }
      // Light from the north-west.
      const double slope = std::isfinite(beside_m) ? (here->elevation_m - beside_m) / 0.28 : 0;
      const double grey = std::clamp(150.0 + 90.0 * std::atan(-slope), 30.0, 240.0);
      const auto level = static_cast<std::uint8_t>(grey);
      const auto dim = static_cast<std::uint8_t>(grey * 0.72);
      image.at<cv::Vec3b>(v, u) = here->safe ? cv::Vec3b(dim, level, dim) : cv::Vec3b(level, level, level);
    }
  }
  cv::circle(image, to_pixel(flown.fence_middle.x(), flown.fence_middle.y()),
             static_cast<int>(flown.fence_m * px_per_m), {255, 255, 255}, 1, cv::LINE_AA);
  put_legend(image, flown, {12, 20});
  lighten(image, {4, kSide_px - 28, 630, 24});
  put(image,
      cv::format("green: truly safe; small circle: the vehicle's footprint; large: geofence of %.0f m radius",
                 flown.fence_m),
      {12, kSide_px - 12});
  for (std::size_t i = 1; i < flown.track.size(); ++i) {
    const Eigen::Vector3d& a = flown.track[i - 1].p_world;
    const Eigen::Vector3d& b = flown.track[i].p_world;
    cv::line(image, to_pixel(a.x(), a.y()), to_pixel(b.x(), b.y()), colour(flown.track[i].state), 2,
             cv::LINE_AA);
  }
  const cv::Point end = to_pixel(flown.result.p_end.x(), flown.result.p_end.y());
  const bool good = flown.result.outcome == Outcome::kSafe;
  cv::circle(image, end, std::max(3, static_cast<int>(body_radius_m * px_per_m)),
             good ? cv::Scalar(0, 255, 0) : cv::Scalar(0, 0, 255), 2, cv::LINE_AA);
  return image;
}

}  // namespace alight::closed_loop
