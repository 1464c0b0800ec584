#include "calibrate/clocks/clock_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "calibrate/clocks/edge_agreement.hpp"
#include "calibrate/clocks/score_peak.hpp"
#include "calibrate/clocks/turn_search.hpp"
#include "calibrate/clocks/view_turns.hpp"
#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kStep_s = 0.005;
constexpr double kNeighbourhood_s = 0.015;

/// Over the whole range in steps, then to the top of the hill.
ClockOffset search(const BlockScores& scores, const ClockAlignmentConfig& config) {
  ClockOffset result;
  const int steps = static_cast<int>(std::ceil(config.max_offset_s / kStep_s));
  std::size_t best = 0;
  for (int i = -steps; i <= steps; ++i) {
    const double offset_s = i * kStep_s;
    result.scores.emplace_back(offset_s, scores(VectorXd::Constant(1, offset_s)).sum());
    if (result.scores.back().second > result.scores[best].second) best = result.scores.size() - 1;
  }
  const ScorePeak peak = climb(scores, VectorXd::Constant(1, result.scores[best].first),
                               VectorXd::Constant(1, kNeighbourhood_s));
  result.offset_s = peak.at[0];
  result.sigma_s = peak.found ? peak.sigma()[0] : 0;
  result.told =
      peak.found && result.sigma_s <= config.max_sigma_s && std::abs(result.offset_s) <= config.max_offset_s;
  return result;
}

/// Of all axes together, each without its mean (wrong extrinsics add one).
double correlation(const std::vector<ViewTurn>& turns) {
  Vector3d mean_seen = Vector3d::Zero();
  Vector3d mean_posed = Vector3d::Zero();
  for (const ViewTurn& turn : turns) {
    mean_seen += turn.seen_rad / static_cast<double>(turns.size());
    mean_posed += turn.posed_rad / static_cast<double>(turns.size());
  }
  double both = 0;
  double seen = 0;
  double posed = 0;
  for (const ViewTurn& turn : turns) {
    both += (turn.seen_rad - mean_seen).dot(turn.posed_rad - mean_posed);
    seen += (turn.seen_rad - mean_seen).squaredNorm();
    posed += (turn.posed_rad - mean_posed).squaredNorm();
  }
  return both / std::sqrt(std::max(seen * posed, 1e-30));
}

/// Where most patches are followed: with a wrong offset many are looked for in the wrong place.
double most_followed_s(const FlightViews& flight, const ClockAlignmentConfig& config) {
  constexpr double kCoarse_s = 0.03;
  constexpr std::size_t kPoints = 40;
  const int steps = static_cast<int>(std::ceil(config.max_offset_s / kCoarse_s));
  std::size_t most = 0;
  double best_s = 0;
  for (int i = 0; i <= 2 * steps; ++i) {
    const double offset_s =
        kCoarse_s * (i % 2 == 0 ? -i / 2 : (i + 1) / 2);  // 0 first: it stays where nothing is better
    std::size_t followed = 0;
    for (const ViewPair& pair :
         follow_views(flight, config.points_window_s, to_nanoseconds(offset_s), kPoints))
      followed += pair.points.size();
    if (followed <= most) continue;
    most = followed;
    best_s = offset_s;
  }
  return best_s;
}

TurnResiduals residuals_around(const FlightViews& flight, double offset_s,
                               const ClockAlignmentConfig& config) {
  constexpr std::size_t kPoints = 120;
  const std::int64_t offset_ns = to_nanoseconds(offset_s);
  return {flight, follow_views(flight, config.points_window_s, offset_ns, kPoints), offset_ns,
          config.smooth_s, config.max_offset_s};
}

void align_camera(const FlightViews& flight, const ClockAlignmentConfig& config, ClockAlignment& result) {
  ClockOffset& camera = result.camera;
  TurnResiduals residuals = residuals_around(flight, most_followed_s(flight, config), config);
  for (int round = 0; round < 2; ++round) {
    const double wanted =
        std::max<double>(config.min_pairs, config.min_followed * static_cast<double>(flight.views.size()));
    if (static_cast<double>(residuals.pairs()) < wanted) {
      camera.told = false;
      camera.reason = fmt::format(
          "only {:.0f} images show what the poses expect of the one before, {:.0f} are needed: fly longer, "
          "in daylight, and check the topics of attitude and position",
          static_cast<double>(residuals.pairs()), wanted);
      return;
    }
    camera = search([&](const VectorXd& at) { return in_blocks(residuals.scores(to_nanoseconds(at[0]))); },
                    config);
    // Once more from there: what is followed now is what belongs together.
    if (round == 0) residuals = residuals_around(flight, camera.offset_s, config);
  }
  result.turns = residuals.turns(to_nanoseconds(camera.offset_s));
  result.correlation = correlation(result.turns);
  if (result.correlation < config.min_correlation) {
    camera.told = false;
    camera.reason = fmt::format(
        "the turns that images and poses show hardly correlate ({:.2f}, at least {:.2f} are needed): fly "
        "curves, and check the attitude's topic and T_cam_imu",
        result.correlation, config.min_correlation);
  } else if (!camera.told) {
    camera.reason = fmt::format(
        "the vehicle turns too steadily (1 sigma {:.1f} ms, at most {:.1f}): fly curves to either side, with "
        "sharp beginnings and ends",
        1e3 * camera.sigma_s, 1e3 * config.max_sigma_s);
  }
}

/// The depth edges on the images' edges, with both clocks shifted.
class ShiftedEdges {
 public:
  ShiftedEdges(const FlightViews& flight, std::int64_t camera_shift_ns, double window_s)
      : flight_(flight), views_(flight.views), window_s_(window_s) {
    for (ExposureView& view : views_) {
      strengths_.push_back(edge_strength(view.left));
      view.t_ns += camera_shift_ns;
    }
  }

  EdgeAgreement at(double lidar_shift_s, int margin_px) const {
    EdgeAgreement agreement(flight_.rig.intrinsics, margin_px);
    for (std::size_t i = 0; i < views_.size(); ++i) {
      agreement.add_view(strengths_[i], seen_from(flight_, views_[i], flight_.edges, window_s_,
                                                  to_nanoseconds(lidar_shift_s)));
    }
    return agreement;
  }

 private:
  const FlightViews& flight_;
  std::vector<ExposureView> views_;
  std::vector<cv::Mat> strengths_;
  double window_s_;
};

void align_lidar(const FlightViews& flight, const ClockAlignmentConfig& config, ClockAlignment& result) {
  constexpr int kMargin_px = 8;
  constexpr int kSearchMargin_px = 24;
  constexpr double kSearch_deg = 2;
  const double camera_s = result.camera.told ? result.camera.offset_s : 0;
  const ShiftedEdges edges(flight, to_nanoseconds(camera_s), config.edges_window_s);
  ClockOffset& lidar = result.lidar;
  const std::size_t points = edges.at(0, kMargin_px).points();
  if (static_cast<int>(points) < config.min_edges || flight.views.size() < 3) {
    lidar.reason =
        fmt::format("only {} depth edges lie in images, {} are needed; fly over houses, trees or boulders",
                    points, config.min_edges);
    return;
  }
  lidar = search(
      [&](const VectorXd& at) {
        return in_blocks(edges.at(at[0], kMargin_px).scores(Eigen::Isometry3d::Identity()));
      },
      config);
  result.stands_out = search_turns(edges.at(lidar.offset_s, kSearchMargin_px), kSearch_deg).stands_out;
  if (result.stands_out < kStandsOut) {
    lidar.told = false;
    lidar.reason = fmt::format(
        "the LiDAR's depth edges lie on the images' edges no better than by chance ({:.1f} standard "
        "deviations, {:.1f} are needed): fly over more that stands up, in daylight, and check T_cam_lidar",
        result.stands_out, kStandsOut);
  } else if (!lidar.told) {
    lidar.reason = fmt::format(
        "the depth edges lie on the images' edges as well at other offsets (1 sigma {:.1f} ms, at most "
        "{:.1f}): fly faster, with turns, over more that stands up",
        1e3 * lidar.sigma_s, 1e3 * config.max_sigma_s);
  }
}

}  // namespace

void bind(Binder& b, ClockAlignmentConfig& c) {
  b.section("log", c.log, "topics and limits of the flight log");
  b.section("views", c.views, "what of the flight is used");
  b.field("max_offset_s", c.max_offset_s, "searched to either side of what the rig says", between(0.03, 5));
  b.field("smooth_s", c.smooth_s, "poses are averaged over so long to either side", between(0, 1));
  b.field("points_window_s", c.points_window_s,
          "LiDAR points measured within half of it of an image are followed to the next one", positive());
  b.field("edges_window_s", c.edges_window_s,
          "LiDAR edges measured within half of it of an image are held against it", positive());
  b.field("max_sigma_s", c.max_sigma_s, "an offset that is less certain is none", positive());
  b.field("min_pairs", c.min_pairs, "images with enough texture for the camera's offset", at_least(3));
  b.field("min_followed", c.min_followed, "share of the images that are followed to the next one",
          between(0, 1));
  b.field("min_correlation", c.min_correlation, "of the turns by images and by poses", between(0, 1));
  b.field("min_edges", c.min_edges, "depth edges for the LiDAR's offset", at_least(10));
}

ClockAlignment align_clocks(const FlightViews& flight, const ClockAlignmentConfig& config) {
  ClockAlignment result;
  align_camera(flight, config, result);
  align_lidar(flight, config, result);
  return result;
}

}  // namespace alight
