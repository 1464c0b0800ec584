#include "calibrate/check/rig_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "foundation/config_reader.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

constexpr double kJudged =
    1.5;  // an axis whose motions show only from so many times the limit on is not judged
constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

AxisCheck judge(std::string name, std::string unit, double by, double sigma, double limit, bool found,
                const RigCheckConfig& config) {
  AxisCheck axis{std::move(name), std::move(unit),
                 found,           by,
                 sigma,           std::max(limit, config.moved_sigmas * sigma),
                 false,           false};
  axis.judged = found && axis.noticed_from <= kJudged * limit;
  axis.moved = found && std::abs(by) > axis.noticed_from;
  return axis;
}

void judge_lidar(const EdgeCheck& edges, const RigCheckConfig& config, std::vector<AxisCheck>& axes) {
  for (int i = 0; i < 3; ++i) {
    axes.push_back(judge(std::string("LiDAR turn about ") + kAxes[static_cast<std::size_t>(i)], "deg",
                         to_degrees(edges.turn.by[i]), to_degrees(edges.turn.sigma[i]),
                         i == 2 ? config.moved_roll_deg : config.moved_turn_deg, edges.peak, config));
  }
  for (int i = 0; i < 3; ++i) {
    axes.push_back(judge(std::string("LiDAR shift along ") + kAxes[static_cast<std::size_t>(i)], "m",
                         edges.shift.by[i], edges.shift.sigma[i], config.moved_shift_m,
                         edges.peak && edges.shift.found, config));
  }
}

bool usable(const StereoAgreement& stereo, const RigCheckConfig& config) {
  return stereo.points >= config.min_stereo_points && stereo.explained >= config.min_stereo_explained;
}

void judge_right(const StereoAgreement& stereo, const RigCheckConfig& config, std::vector<AxisCheck>& axes) {
  for (int i = 0; i < 3; ++i) {
    axes.push_back(judge(std::string("right camera turn about ") + kAxes[static_cast<std::size_t>(i)], "deg",
                         to_degrees(stereo.turn_rad[i]), to_degrees(stereo.sigma_rad[i]),
                         config.moved_eye_deg, usable(stereo, config), config));
  }
}

std::string why_no_peak(const EdgeCheck& edges, const EdgeCheckConfig& config) {
  if (edges.edges < config.min_edges) {
    return fmt::format(
        "the LiDAR saw only {} depth edges where a camera sees them too, {} are needed; fly over houses, "
        "trees or boulders, or longer",
        edges.edges, config.min_edges);
  }
  return fmt::format(
      "the LiDAR's depth edges lie on the images' edges nowhere better than by chance (the best place stands "
      "out by {:.1f} standard deviations, {:.1f} are needed): the images show no edges, poses are wrong, "
      "clocks disagree, or the LiDAR is turned by more than {:.1f} deg",
      edges.stands_out, config.min_stands_out, config.max_turn_deg);
}

void explain(const RigCheckConfig& config, RigCheck& check) {
  for (const AxisCheck& axis : check.axes) {
    if (axis.moved) check.reasons.push_back(fmt::format("{}: {:+.3f} {}", axis.name, axis.by, axis.unit));
  }
  for (const AxisCheck& axis : check.axes) {
    if (axis.found && !axis.judged && axis.unit == "deg")
      check.reasons.push_back(fmt::format(
          "{} cannot be judged: it would show only from {:.2f} {} on; fly longer or over more that stands up",
          axis.name, axis.noticed_from, axis.unit));
  }
  if (!check.edges.peak) check.reasons.push_back(why_no_peak(check.edges, config.edges));
  if (check.has_right && check.stereo.points < config.min_stereo_points) {
    check.reasons.push_back(
        fmt::format("only {} LiDAR points lie on texture that both cameras see, {} are needed: it is too "
                    "dark, or the right camera is turned by more than a degree",
                    check.stereo.points, config.min_stereo_points));
  } else if (check.has_right && !usable(check.stereo, config)) {
    check.reasons.push_back(
        fmt::format("no turn of the right camera explains where it sees the left one's patches ({:.0f} % of "
                    "{}, {:.0f} % are needed): the cameras' stamps or topics do not belong together, or the "
                    "right camera is turned by more than a degree",
                    100 * check.stereo.explained, check.stereo.points, 100 * config.min_stereo_explained));
  }
}

RigVerdict verdict_of(const RigCheck& check) {
  if (std::any_of(check.axes.begin(), check.axes.end(), [](const AxisCheck& axis) { return axis.moved; }))
    return RigVerdict::kMoved;
  // Shifts that a log cannot judge are no obstacle: a mount that is knocked turns.
  const bool all = std::all_of(check.axes.begin(), check.axes.end(),
                               [](const AxisCheck& axis) { return axis.judged || axis.unit == "m"; });
  return all ? RigVerdict::kGood : RigVerdict::kCannotTell;
}

}  // namespace

void bind(Binder& b, RigCheckConfig& c) {
  b.section("log", c.log, "topics and limits of the flight log");
  b.section("views", c.views, "what of the flight is used");
  b.section("edges", c.edges, "depth edges against image edges");
  b.field("stereo_window_s", c.stereo_window_s,
          "LiDAR points measured within half of it of an image compare the two cameras", positive());
  b.field("min_stereo_points", c.min_stereo_points, "fewer say nothing", at_least(10));
  b.field("min_stereo_explained", c.min_stereo_explained,
          "share of these points that one turn has to explain", between(0, 1));
  b.field("moved_turn_deg", c.moved_turn_deg,
          "the LiDAR has moved where a turn about x or y by more betters the agreement", positive());
  b.field("moved_roll_deg", c.moved_roll_deg, "or about the camera's optical axis z", positive());
  b.field("moved_shift_m", c.moved_shift_m, "or a shift", positive());
  b.field("moved_eye_deg", c.moved_eye_deg, "the right camera has moved where a turn by more does",
          positive());
  b.field("moved_sigmas", c.moved_sigmas, "and by more than so many standard deviations", positive());
}

const char* name(RigVerdict verdict) {
  switch (verdict) {
    case RigVerdict::kGood:
      return "good";
    case RigVerdict::kMoved:
      return "moved";
    case RigVerdict::kCannotTell:
      break;
  }
  return "cannot tell";
}

EdgeAgreement edge_agreement_of(const FlightViews& flight, const EdgeCheckConfig& config) {
  constexpr int kMargin_px =
      24;  // room for the search; points that leave the image would count as its border
  EdgeAgreement agreement(flight.rig.intrinsics, kMargin_px);
  for (const ExposureView& view : flight.views)
    agreement.add_view(edge_strength(view.left), seen_from(flight, view, flight.edges, config.window_s));
  return agreement;
}

RigCheck check_rig(const FlightViews& flight, const RigCheckConfig& config) {
  RigCheck check;
  check.edges = check_edges(edge_agreement_of(flight, config.edges), config.edges);
  judge_lidar(check.edges, config, check.axes);
  check.has_right = flight.rig.baseline_m > 0;
  if (check.has_right) {
    check.stereo = stereo_agreement(flight, config.stereo_window_s);
    judge_right(check.stereo, config, check.axes);
  }
  check.verdict = verdict_of(check);
  explain(config, check);
  return check;
}

}  // namespace alight
