#include "calibrate/check/rig_check_report.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "geometry/frames.hpp"

namespace alight {
namespace {

const char* judgement(const AxisCheck& axis) {
  if (axis.moved) return "MOVED";
  return axis.judged ? "as the rig says" : "cannot be judged by this log";
}

std::string axis_line(const AxisCheck& axis) {
  if (!axis.found)
    return fmt::format("{:28} {:>10} {:>10} {:>13} {}\n", axis.name, "-", "-", "-", judgement(axis));
  return fmt::format("{:28} {:>+10.3f} {:>10.4f} {:>8.2f} {:4} {}\n", axis.name, axis.by, axis.sigma,
                     axis.noticed_from, axis.unit, judgement(axis));
}

void draw_title(cv::Mat& picture, const std::string& title) {
  cv::putText(picture, title, {10, 24}, cv::FONT_HERSHEY_SIMPLEX, 0.6, {0, 0, 0}, 4, cv::LINE_AA);
  cv::putText(picture, title, {10, 24}, cv::FONT_HERSHEY_SIMPLEX, 0.6, {255, 255, 255}, 1, cv::LINE_AA);
}

std::size_t richest_view(const EdgeAgreement& agreement) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < agreement.views(); ++i) {
    if (agreement.points_of(i) > agreement.points_of(best)) best = i;
  }
  return best;
}

cv::Mat draw_view(const cv::Mat& grey, const EdgeAgreement& agreement, std::size_t view,
                  const Eigen::Isometry3d& better, bool show_better) {
  constexpr double kScale = 2;
  cv::Mat picture;
  cv::cvtColor(grey, picture, cv::COLOR_GRAY2BGR);
  cv::resize(picture, picture, {}, kScale, kScale, cv::INTER_LINEAR);
  const auto draw = [&](const Eigen::Isometry3d& motion, const cv::Scalar& colour) {
    for (const Eigen::Vector2d& p : agreement.pixels(view, motion)) {
      cv::circle(picture,
                 {static_cast<int>((p.x() + 0.5) * kScale), static_cast<int>((p.y() + 0.5) * kScale)}, 1,
                 colour, cv::FILLED, cv::LINE_AA);
    }
  };
  draw(Eigen::Isometry3d::Identity(), {60, 60, 255});
  if (show_better) draw(better, {80, 230, 80});
  return picture;
}

/// Agreement over turns about x (across) and y (down), at the best roll; bright is better.
cv::Mat draw_scores(const EdgeAgreement& agreement, const RigCheck& check, double reach_deg, int size_px) {
  constexpr int kCells = 41;
  cv::Mat scores(kCells, kCells, CV_32FC1);
  const auto turn_deg = [&](int cell) { return reach_deg * (2.0 * cell / (kCells - 1) - 1); };
  const std::size_t every_nth = agreement.points() / 6000 + 1;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const Eigen::Vector3d turn(to_radians(turn_deg(column)), to_radians(turn_deg(row)),
                                 check.edges.turn.by.z());
      const std::vector<double> parts = agreement.scores(motion_of(turn, Eigen::Vector3d::Zero()), every_nth);
      scores.at<float>(row, column) = static_cast<float>(std::accumulate(parts.begin(), parts.end(), 0.0));
    }
  }
  cv::Mat grey;
  cv::normalize(scores, grey, 0, 255, cv::NORM_MINMAX, CV_8U);
  cv::Mat picture;
  cv::resize(grey, picture, {size_px, size_px}, 0, 0, cv::INTER_NEAREST);
  cv::applyColorMap(picture, picture, cv::COLORMAP_VIRIDIS);
  const auto place = [&](double x_rad, double y_rad) {
    const auto at = [&](double rad) {
      return static_cast<int>(size_px * (0.5 + to_degrees(rad) / reach_deg * 0.5 * (kCells - 1) / kCells));
    };
    return cv::Point(at(x_rad), at(y_rad));
  };
  cv::drawMarker(picture, place(0, 0), {60, 60, 255}, cv::MARKER_CROSS, 22, 2);
  if (check.edges.turn.found)
    cv::drawMarker(picture, place(check.edges.turn.by.x(), check.edges.turn.by.y()), {80, 230, 80},
                   cv::MARKER_TILTED_CROSS, 18, 2);
  return picture;
}

}  // namespace

std::string format_rig_check(const RigCheck& check) {
  const EdgeCheck& e = check.edges;
  std::string text = fmt::format("verdict: {}\n", name(check.verdict));
  for (const std::string& reason : check.reasons) text += "  " + reason + "\n";
  text += fmt::format("\nLiDAR's depth edges against image edges: {} edges in {} images\n", e.edges, e.views);
  text += fmt::format(
      "  score {:.3f}, at its best nearby {:.3f}, by chance {:.3f}; the best stands out by {:.1f} standard "
      "deviations\n",
      e.score, e.best_score, e.chance, e.stands_out);
  if (check.has_right) {
    const StereoAgreement& s = check.stereo;
    text += fmt::format("left against right camera at the LiDAR's points: {} points in {} images\n", s.points,
                        s.views);
    text += fmt::format(
        "  correlation {:.3f}, at its best nearby {:.3f}, {:.2f} px away; one turn explains {:.0f} %\n",
        s.correlation, s.best_correlation, s.offset_px, 100 * s.explained);
  }
  text += fmt::format("\n{:28} {:>10} {:>10} {:>8}\n", "what would better them", "by", "1 sigma", "from");
  for (const AxisCheck& axis : check.axes) text += axis_line(axis);
  text +=
      "\nfrom: what a motion has to exceed to be noticed. Axes: x right, y down, z forward.\n"
      "T_cam_lidar = Exp(turn) * (T_cam_lidar of the rig file) would better the agreement; T_cn_cnm1 of cam1 "
      "alike.\n"
      "The shift comes on top of the turn; from high up the two look alike.\n";
  return text;
}

std::string rig_check_json(const RigCheck& check) {
  const EdgeCheck& e = check.edges;
  nlohmann::json json;
  json["verdict"] = name(check.verdict);
  json["reasons"] = check.reasons;
  json["edges"] = {{"edges", e.edges},           {"views", e.views},   {"score", e.score},
                   {"best_score", e.best_score}, {"chance", e.chance}, {"stands_out", e.stands_out}};
  if (check.has_right) {
    json["stereo"] = {
        {"points", check.stereo.points},           {"views", check.stereo.views},
        {"correlation", check.stereo.correlation}, {"best_correlation", check.stereo.best_correlation},
        {"offset_px", check.stereo.offset_px},     {"explained", check.stereo.explained}};
  }
  for (const AxisCheck& axis : check.axes) {
    nlohmann::json row = {{"name", axis.name},
                          {"unit", axis.unit},
                          {"noticed_from", axis.noticed_from},
                          {"judged", axis.judged},
                          {"moved", axis.moved}};
    if (axis.found) row["by"] = axis.by;
    if (axis.found) row["sigma"] = axis.sigma;
    json["axes"].push_back(row);
  }
  return json.dump(2) + "\n";
}

cv::Mat draw_rig_check(const FlightViews& flight, const RigCheck& check, const RigCheckConfig& config) {
  const EdgeAgreement agreement = edge_agreement_of(flight, config.edges);
  if (agreement.points() == 0) {
    cv::Mat nothing(400, 640, CV_8UC3, cv::Scalar(40, 40, 40));
    draw_title(nothing, "no depth edge lies in an image");
    return nothing;
  }
  const std::size_t view = richest_view(agreement);
  const Eigen::Isometry3d better = motion_of(check.edges.turn.by, Eigen::Vector3d::Zero());
  cv::Mat left = draw_view(flight.views[view].left, agreement, view, better, check.edges.peak);
  cv::Mat right = draw_scores(agreement, check, config.edges.max_turn_deg, left.rows);
  draw_title(left, check.edges.peak ? "depth edges: as the rig says (red), at their best (green)"
                                    : "depth edges as the rig says");
  draw_title(right, fmt::format("agreement, turns +-{:.1f} deg about x (right), y (down)",
                                config.edges.max_turn_deg));
  cv::Mat picture;
  cv::hconcat(left, right, picture);
  return picture;
}

}  // namespace alight
