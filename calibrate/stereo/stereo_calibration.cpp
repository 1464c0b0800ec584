#include "calibrate/stereo/stereo_calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>

#include <fmt/format.h>

#include "calibrate/fitting/rigid_motion.hpp"
#include "calibrate/stereo/camera_calibration.hpp"
#include "calibrate/stereo/stereo_bundle.hpp"
#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "foundation/order_statistics.hpp"
#include "geometry/frames.hpp"
#include "geometry/rig/stereo_rectification.hpp"

namespace alight {
namespace {

std::vector<std::size_t> used_views(const std::vector<StereoView>& views) {
  std::vector<std::size_t> used;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].used) used.push_back(i);
  }
  return used;
}

void require_views(const std::vector<StereoView>& views, int min_views) {
  const auto used = static_cast<int>(used_views(views).size());
  if (used >= min_views) return;
  std::string list;
  for (const StereoView& view : views) {
    if (!view.used) list += "\n  " + view.name + ": " + view.reason;
  }
  throw DataError("only " + std::to_string(used) + " of " + std::to_string(views.size()) +
                  " views are usable, " + std::to_string(min_views) + " are needed (20 are good)" + list);
}

BundleResult calibrate_used(const Chessboard& board, const std::vector<StereoView>& views,
                            const std::vector<std::size_t>& used, const StereoCalibrationConfig& config) {
  std::vector<Corners> left;
  std::vector<Corners> right;
  std::vector<StereoCorners> both;
  for (const std::size_t i : used) {
    left.push_back(views[i].left_corners);
    right.push_back(views[i].right_corners);
    both.push_back({&views[i].left_corners, &views[i].right_corners});
  }
  const cv::Size size = views[used.front()].left.size();
  auto in_parallel =
      std::async(std::launch::async, [&] { return calibrate_camera(board, right, size, config); });
  const CameraStart start_left = calibrate_camera(board, left, size, config);
  const CameraStart start_right = in_parallel.get();
  StereoBundle start{start_left.camera, start_right.camera, Eigen::Isometry3d::Identity(),
                     start_left.T_camera_board};
  // Each view has an opinion on the right camera's place; the one that suits all views best is the start.
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < used.size(); ++i) {
    const Eigen::Isometry3d T = start_right.T_camera_board[i] * start_left.T_camera_board[i].inverse();
    double error = 0;
    for (std::size_t k = 0; k < used.size(); ++k) {
      const Corners seen = project_board(board, start_right.camera, T * start_left.T_camera_board[k]);
      error += cv::norm(seen, right[k], cv::NORM_L1);
    }
    if (error >= best) continue;
    best = error;
    start.T_right_left = T;
  }
  return refine_stereo(board, both, start);
}

/// Leaves out the view that fits worst if it is far worse than the others. @returns whether it did
bool reject_worst(std::vector<StereoView>& views, const std::vector<std::size_t>& used,
                  const BundleResult& result, const Chessboard& board,
                  const StereoCalibrationConfig& config) {
  std::vector<double> rms;
  for (std::size_t k = 0; k < used.size(); ++k) {
    StereoView& view = views[used[k]];
    view.rms_left_px = std::sqrt(result.errors[k].left / board.corners());
    view.rms_right_px = std::sqrt(result.errors[k].right / board.corners());
    rms.push_back(std::sqrt((result.errors[k].left + result.errors[k].right) / (2 * board.corners())));
  }
  const double median_px = median(std::vector<double>(rms));
  const auto worst = static_cast<std::size_t>(std::max_element(rms.begin(), rms.end()) - rms.begin());
  if (rms[worst] < std::max(config.min_rejected_rms_px, config.max_view_over_median * median_px))
    return false;
  views[used[worst]].used = false;
  views[used[worst]].reason = fmt::format(
      "fits with {:.2f} px, the median view with {:.2f} px: the board moved between the cameras' exposures, "
      "was "
      "bent, or a corner was mistaken",
      rms[worst], median_px);
  return true;
}

double coverage(const std::vector<StereoView>& views, bool left) {
  constexpr int kCells = 10;
  std::array<std::array<bool, kCells>, kCells> seen{};
  for (const StereoView& view : views) {
    if (!view.used) continue;
    for (const cv::Point2f& corner : left ? view.left_corners : view.right_corners) {
      const int column = std::clamp(static_cast<int>(corner.x * kCells) / view.left.cols, 0, kCells - 1);
      const int row = std::clamp(static_cast<int>(corner.y * kCells) / view.left.rows, 0, kCells - 1);
      seen[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] = true;
    }
  }
  int count = 0;
  for (const auto& row : seen) count += static_cast<int>(std::count(row.begin(), row.end(), true));
  return count / static_cast<double>(kCells * kCells);
}

void measure_epipolar(StereoCalibration& result) {
  Rig rig = result.rig;
  rig.lidar0 = RigLidar();  // a sensor at the left camera: its extrinsics are then the rectifying turn
  const RectifiedRig rectified = StereoRectifier(rig).rig();
  const Eigen::Matrix3d R_left = rectified.T_camera_lidar.linear();
  const Eigen::Matrix3d R_right = R_left * rig.T_cam1_cam0.linear().transpose();
  double sum = 0;
  double count = 0;
  const auto row = [&](const Camera& camera, const Eigen::Matrix3d& R, const cv::Point2f& corner) {
    const Eigen::Vector3d ray =
        camera.unproject({static_cast<double>(corner.x), static_cast<double>(corner.y)});
    return rectified.intrinsics.project(R * ray).y();
  };
  for (const StereoView& view : result.views) {
    if (!view.used) continue;
    for (std::size_t i = 0; i < view.left_corners.size(); ++i) {
      const double off = row(rig.cam0.camera, R_left, view.left_corners[i]) -
                         row(rig.cam1->camera, R_right, view.right_corners[i]);
      sum += off * off;
      count += 1;
      result.epipolar_max_px = std::max(result.epipolar_max_px, std::abs(off));
    }
  }
  result.epipolar_rms_px = std::sqrt(sum / std::max(1.0, count));
}

void list_estimates(const BundleResult& bundle, StereoCalibration& result) {
  Eigen::Index at = 0;
  const auto lens = [&](const std::string& name, const Camera& camera) {
    const PinholeIntrinsics& k = camera.intrinsics;
    const bool fisheye = camera.distortion_model == DistortionModel::kEquidistant;
    const std::vector<std::string> names = fisheye ? std::vector<std::string>{"k1", "k2", "k3", "k4"}
                                                   : std::vector<std::string>{"k1", "k2", "p1", "p2", "k3"};
    const std::array<std::pair<const char*, double>, 4> pinhole = {
        {{"fx_px", k.fx_px}, {"fy_px", k.fy_px}, {"cx_px", k.cx_px}, {"cy_px", k.cy_px}}};
    for (const auto& [parameter, value] : pinhole)
      result.estimates.push_back({name + " " + parameter, value, bundle.sigma[at++]});
    for (std::size_t i = 0; i < camera.distortion_coeffs.size(); ++i)
      result.estimates.push_back({name + " " + names[i], camera.distortion_coeffs[i], bundle.sigma[at++]});
  };
  lens("cam0", bundle.bundle.left);
  lens("cam1", bundle.bundle.right);
  const Vector6d motion = motion_vector(bundle.bundle.T_right_left);
  const std::array<const char*, 6> names = {"x_m", "y_m", "z_m", "turn x_deg", "turn y_deg", "turn z_deg"};
  for (std::size_t i = 0; i < 6; ++i) {
    const double unit = i < 3 ? 1 : 1 / kRadiansPerDegree;
    const auto k = static_cast<Eigen::Index>(i);
    result.estimates.push_back(
        {std::string("T_cam1_cam0 ") + names[i], unit * motion[k], unit * bundle.sigma[at++]});
  }
}

}  // namespace

void bind(Binder& b, StereoCalibrationConfig& c) {
  b.choice("model", c.model,
           {{"radtan", DistortionModel::kRadtan}, {"equidistant", DistortionModel::kEquidistant}},
           "of the lenses; equidistant for fisheyes");
  b.field("radtan_coefficients", c.radtan_coefficients, "4: k1 k2 p1 p2; 5: and k3", between(4, 5));
  b.field("max_view_over_median", c.max_view_over_median,
          "views with an RMS over so many medians are left out", at_least(1));
  b.field("min_rejected_rms_px", c.min_rejected_rms_px, "but none with less than this", at_least(0));
  b.field("min_views", c.min_views, "that have to be usable", between(3, 1000));
  b.field("min_coverage", c.min_coverage, "share of the image with corners, below which a warning is given",
          between(0, 1));
  b.field("threads", c.threads, "views that are searched at a time", between(1, 64));
}

StereoCalibration calibrate_stereo(const Chessboard& board, std::vector<StereoView> views,
                                   const StereoCalibrationConfig& config) {
  for (StereoView& view : views) view.used = view.reason.empty();
  require_views(views, config.min_views);
  std::vector<std::size_t> used = used_views(views);
  BundleResult bundle = calibrate_used(board, views, used, config);
  while (reject_worst(views, used, bundle, board, config)) {
    require_views(views, config.min_views);
    used = used_views(views);
    bundle = calibrate_used(board, views, used, config);
  }
  StereoCalibration result;
  result.views = std::move(views);
  result.rig.cam0.camera = bundle.bundle.left;
  result.rig.cam1 = RigCamera();
  result.rig.cam1->camera = bundle.bundle.right;
  result.rig.T_cam1_cam0 = bundle.bundle.T_right_left;
  result.rig.T_cam1_cam0.linear() = nearest_rotation(result.rig.T_cam1_cam0.linear());
  double sum = 0;
  for (const ViewError& error : bundle.errors) sum += error.left + error.right;
  result.rms_px = std::sqrt(sum / (2.0 * board.corners() * static_cast<double>(bundle.errors.size())));
  list_estimates(bundle, result);
  measure_epipolar(result);
  result.coverage_left = coverage(result.views, true);
  result.coverage_right = coverage(result.views, false);
  return result;
}

}  // namespace alight
