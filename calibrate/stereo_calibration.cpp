#include "calibrate/stereo_calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <future>
#include <limits>

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include "calibrate/rigid_motion.hpp"
#include "calibrate/stereo_bundle.hpp"
#include "configs/errors.hpp"
#include "geometry/frames.hpp"
#include "geometry/stereo_rectification.hpp"

namespace alight {
namespace {

template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[240];
  std::snprintf(buffer, sizeof(buffer), format, values...);
  return buffer;
}

/// The eyes hang upright beside each other, so that the board looks alike to both: the order of the right corners in
/// which they lie as the left ones do, but for a shift.
void match_order(const Chessboard& board, const Corners& left, Corners& right) {
  Corners best = right;
  double best_spread = std::numeric_limits<double>::infinity();
  for (const Eigen::Isometry3d& turn : board_turns(board)) {
    Corners turned;
    cv::Point2d mean(0, 0);
    for (int i = 0; i < board.corners(); ++i) {
      const Eigen::Vector3d at = turn * board.corner(i) / board.square_m;
      const auto index = static_cast<std::size_t>(std::lround(at.y()) * board.columns + std::lround(at.x()));
      turned.push_back(right[index]);
      mean += cv::Point2d(right[index] - left[static_cast<std::size_t>(i)]) / board.corners();
    }
    double spread = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      const cv::Point2d off = cv::Point2d(turned[i] - left[i]) - mean;
      spread += off.dot(off);
    }
    if (spread >= best_spread) continue;
    best_spread = spread;
    best = turned;
  }
  right = best;
}

void find_board(const Chessboard& board, StereoView& view) {
  const auto left = find_chessboard(view.left, board);
  const auto right = find_chessboard(view.right, board);
  if (!left || !right) {
    view.reason = (left    ? "right: "
                   : right ? "left: "
                           : "both eyes: ") +
                  why_not_found(left ? view.right : view.left, board);
    return;
  }
  view.left_corners = *left;
  view.right_corners = *right;
  match_order(board, view.left_corners, view.right_corners);
}

Camera camera_of(const cv::Mat& K, const cv::Mat& D, cv::Size size, DistortionModel model) {
  Camera camera;
  camera.intrinsics = {K.at<double>(0, 0), K.at<double>(1, 1), K.at<double>(0, 2),
                       K.at<double>(1, 2), size.width,         size.height};
  camera.distortion_model = model;
  for (int i = 0; i < static_cast<int>(D.total()); ++i) camera.distortion_coeffs.push_back(D.at<double>(i));
  return camera;
}

struct Eye {
  Camera camera;
  std::vector<Eigen::Isometry3d> T_camera_board;
};

/// One camera alone, by OpenCV.
Eye calibrate_eye(const Chessboard& board, const std::vector<Corners>& corners, cv::Size size,
                  const StereoCalibrationConfig& config) {
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  cv::Mat K;
  cv::Mat D;
  if (config.model == DistortionModel::kEquidistant) {
    std::vector<std::vector<cv::Point3d>> points;
    std::vector<std::vector<cv::Point2d>> pixels;
    for (const Corners& view : corners) {
      std::vector<cv::Point3d> p;
      for (const cv::Point3f& corner : board.corner_points()) p.emplace_back(corner);
      points.push_back(p);
      pixels.emplace_back(view.begin(), view.end());
    }
    cv::fisheye::calibrate(points, pixels, size, K, D, rotations, translations,
                           cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW);
  } else {
    const std::vector<std::vector<cv::Point3f>> points(corners.size(), board.corner_points());
    cv::calibrateCamera(points, corners, size, K, D, rotations, translations,
                        config.radtan_coefficients == 4 ? cv::CALIB_FIX_K3 : 0);
    D = D.reshape(1, 1).colRange(0, config.radtan_coefficients).clone();
  }
  Eye eye{camera_of(K, D, size, config.model), {}};
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    cv::Mat R;
    cv::Rodrigues(rotations[i], R);
    Eigen::Matrix3d R_eigen;
    cv::cv2eigen(R, R_eigen);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = R_eigen;
    const cv::Mat t = translations[i].reshape(1, 3);
    T.translation() = Eigen::Vector3d(t.at<double>(0), t.at<double>(1), t.at<double>(2));
    eye.T_camera_board.push_back(T);
  }
  return eye;
}

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
  auto right_eye = std::async(std::launch::async, [&] { return calibrate_eye(board, right, size, config); });
  const Eye eye_left = calibrate_eye(board, left, size, config);
  const Eye eye_right = right_eye.get();
  StereoBundle start{eye_left.camera, eye_right.camera, Eigen::Isometry3d::Identity(),
                     eye_left.T_camera_board};
  // Each view has an opinion on the right camera's place; the one that suits all views best is the start.
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < used.size(); ++i) {
    const Eigen::Isometry3d T = eye_right.T_camera_board[i] * eye_left.T_camera_board[i].inverse();
    double error = 0;
    for (std::size_t k = 0; k < used.size(); ++k) {
      const Corners seen = project_board(board, eye_right.camera, T * eye_left.T_camera_board[k]);
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
  std::vector<double> sorted = rms;
  std::sort(sorted.begin(), sorted.end());
  const double median = sorted[sorted.size() / 2];
  const auto worst = static_cast<std::size_t>(std::max_element(rms.begin(), rms.end()) - rms.begin());
  if (rms[worst] < std::max(config.min_rejected_rms_px, config.max_view_over_median * median)) return false;
  views[used[worst]].used = false;
  views[used[worst]].reason = text(
      "fits with %.2f px, the median view with %.2f px: the board moved between the eyes' exposures, was "
      "bent, or "
      "a corner was mistaken",
      rms[worst], median);
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
  rig.lidar0 = RigLidar();  // a sensor at the left camera: its mounting is then the rectifying turn
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
  const auto lens = [&](const std::string& eye, const Camera& camera) {
    const PinholeIntrinsics& k = camera.intrinsics;
    const bool fisheye = camera.distortion_model == DistortionModel::kEquidistant;
    const std::vector<std::string> names = fisheye ? std::vector<std::string>{"k1", "k2", "k3", "k4"}
                                                   : std::vector<std::string>{"k1", "k2", "p1", "p2", "k3"};
    const std::array<std::pair<const char*, double>, 4> pinhole = {
        {{"fx_px", k.fx_px}, {"fy_px", k.fy_px}, {"cx_px", k.cx_px}, {"cy_px", k.cy_px}}};
    for (const auto& [name, value] : pinhole)
      result.estimates.push_back({eye + " " + name, value, bundle.sigma[at++]});
    for (std::size_t i = 0; i < camera.distortion_coeffs.size(); ++i)
      result.estimates.push_back({eye + " " + names[i], camera.distortion_coeffs[i], bundle.sigma[at++]});
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

void find_boards(const Chessboard& board, std::vector<StereoView>& views, int threads) {
  for (const StereoView& view : views) {
    for (const cv::Mat* image : {&view.left, &view.right}) {
      if (image->size() == views.front().left.size()) continue;
      throw DataError(
          view.name + ": the " + (image == &view.left ? "left" : "right") +
          text(" image has %dx%d pixels, the first view's %dx%d; all have to be of one resolution, "
               "recorded as they will be used",
               image->cols, image->rows, views.front().left.cols, views.front().left.rows));
    }
  }
  const auto step = static_cast<std::size_t>(std::max(1, threads));
  for (std::size_t first = 0; first < views.size(); first += step) {
    std::vector<std::future<void>> running;
    for (std::size_t i = first; i < std::min(first + step, views.size()); ++i)
      running.push_back(std::async(std::launch::async, [&board, &views, i] { find_board(board, views[i]); }));
    for (std::future<void>& search : running) search.get();
  }
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

std::string format_stereo_report(const StereoCalibration& calibration) {
  const auto used = used_views(calibration.views).size();
  std::string report = text("RMS %.3f px over %zu views\n", calibration.rms_px, used);
  report += text("epipolar error after rectification: RMS %.3f px, largest %.2f px\n",
                 calibration.epipolar_rms_px, calibration.epipolar_max_px);
  report += text("image covered by corners: left %.0f %%, right %.0f %%\n\n", 100 * calibration.coverage_left,
                 100 * calibration.coverage_right);
  report += text("%-22s %12s %10s\n", "parameter", "value", "1 sigma");
  for (const Estimate& e : calibration.estimates)
    report += text("%-22s %12.5f %10.5f\n", e.name.c_str(), e.value, e.sigma);
  report += text("\n%-28s %10s %10s\n", "view", "left [px]", "right [px]");
  for (const StereoView& view : calibration.views) {
    if (view.used)
      report += text("%-28s %10.3f %10.3f\n", view.name.c_str(), view.rms_left_px, view.rms_right_px);
  }
  for (const StereoView& view : calibration.views) {
    if (!view.used) report += view.name + " left out: " + view.reason + "\n";
  }
  return report;
}

cv::Mat draw_rectified(const StereoCalibration& calibration, const StereoView& view) {
  constexpr int kLineDistance_px = 24;
  const StereoRectifier rectifier(calibration.rig);
  cv::Mat both;
  cv::hconcat(rectifier.rectify_left(view.left), rectifier.rectify_right(view.right), both);
  cv::Mat picture;
  cv::cvtColor(both, picture, cv::COLOR_GRAY2BGR);
  for (int v = kLineDistance_px / 2; v < picture.rows; v += kLineDistance_px) {
    const bool even = v / kLineDistance_px % 2 == 0;
    cv::line(picture, {0, v}, {picture.cols - 1, v},
             even ? cv::Scalar(80, 220, 80) : cv::Scalar(60, 160, 255));
  }
  return picture;
}

}  // namespace alight
