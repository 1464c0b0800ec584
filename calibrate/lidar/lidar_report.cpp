#include "calibrate/lidar/lidar_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "foundation/output_folder.hpp"
#include "geometry/frames.hpp"
#include "pictures/picture_file.hpp"

namespace alight {
namespace {

constexpr int kPanelHeight_px = 640;

std::string board_lines(const Extrinsics& e) {
  std::string text =
      fmt::format("{:24} {:>9} {:>9} {:>9}\n", "board", "RMSE [px]", "dist. [m]", "tilt [deg]");
  for (const BoardResult& board : e.boards) {
    text += fmt::format("{:24} {:>9.3f} {:>9.2f} {:>9.0f}  {}\n", board.name, board.rmse_px, board.distance_m,
                        board.tilt_deg, board.used ? "" : ("left out: " + board.reason));
  }
  return text;
}

cv::Mat panel(const cv::Mat& image, const std::string& title) {
  cv::Mat scaled;
  const double scale = static_cast<double>(kPanelHeight_px) / image.rows;
  cv::resize(image, scaled, {}, scale, scale, scale > 1 ? cv::INTER_NEAREST : cv::INTER_AREA);
  cv::putText(scaled, title, {10, 24}, cv::FONT_HERSHEY_SIMPLEX, 0.6, {0, 0, 0}, 4, cv::LINE_AA);
  cv::putText(scaled, title, {10, 24}, cv::FONT_HERSHEY_SIMPLEX, 0.6, {255, 255, 255}, 1, cv::LINE_AA);
  return scaled;
}

cv::Mat to_bgr(const cv::Mat& grey) {
  cv::Mat bgr;
  cv::cvtColor(grey, bgr, cv::COLOR_GRAY2BGR);
  return bgr;
}

/// The board's surroundings, which is what a picture of it is about.
cv::Rect around(const Corners& corners, cv::Size size) {
  cv::Rect box = cv::boundingRect(corners);
  const int margin = std::max(box.width, box.height) / 2 + 8;
  box -= cv::Point(margin, margin);
  box += cv::Size(2 * margin, 2 * margin);
  return box & cv::Rect({}, size);
}

void draw_points(cv::Mat& image, double scale, const cv::Rect& box, const SceneResult& scene,
                 const Camera& camera, const Eigen::Isometry3d& T_camera_lidar) {
  cv::Mat level(1, 256, CV_8UC1);
  for (int i = 0; i < 256; ++i) level.at<std::uint8_t>(0, i) = cv::saturate_cast<std::uint8_t>(i * 255 / 150);
  cv::Mat colours;
  cv::applyColorMap(level, colours, cv::COLORMAP_PLASMA);
  for (const LidarReturn& point : scene.scene.points) {
    const auto pixel = camera.project(T_camera_lidar * point.p_lidar.cast<double>());
    if (!pixel || !box.contains({static_cast<int>(pixel->x()), static_cast<int>(pixel->y())})) continue;
    const cv::Point at(static_cast<int>((pixel->x() - box.x + 0.5) * scale),
                       static_cast<int>((pixel->y() - box.y + 0.5) * scale));
    cv::circle(image, at, 1, colours.at<cv::Vec3b>(0, point.reflectivity), cv::FILLED);
  }
}

}  // namespace

std::string format_lidar_report(const LidarCalibration& calibration) {
  const Extrinsics& e = calibration.extrinsics;
  const Vector6d sigma = e.sigma();
  const Eigen::Vector3d& t = e.T_camera_lidar.translation();
  std::string text = "T_cam_lidar, with 1 sigma in the camera's frame (x right, y down, z forward):\n";
  text += fmt::format("  translation  {:>9.4f} {:>9.4f} {:>9.4f} m    +- {:.2f} {:.2f} {:.2f} mm\n", t.x(),
                      t.y(), t.z(), 1e3 * sigma[0], 1e3 * sigma[1], 1e3 * sigma[2]);
  const Eigen::Matrix3d R = e.T_camera_lidar.linear();
  text += fmt::format("  rotation     {:>9.5f} {:>9.5f} {:>9.5f}      +- {:.4f} {:.4f} {:.4f} deg\n", R(0, 0),
                      R(0, 1), R(0, 2), to_degrees(sigma[3]), to_degrees(sigma[4]), to_degrees(sigma[5]));
  for (int row = 1; row < 3; ++row)
    text += fmt::format("               {:>9.5f} {:>9.5f} {:>9.5f}\n", R(row, 0), R(row, 1), R(row, 2));
  text += fmt::format(
      "reprojection RMSE  {:.3f} px; the camera's corners alone scatter by {:.3f} px a coordinate\n",
      e.rmse_px, e.camera_noise_px);
  text += fmt::format("residuals          {:.2f} times what was expected{}\n", e.excess,
                      e.excess > 1 ? ": the standard deviations are widened by it" : "");
  text += fmt::format(
      "range offset       {:+.1f} +- {:.1f} mm (how much too far the LiDAR measures; not part of a rig "
      "file)\n",
      1e3 * e.range_offset_m, 1e3 * e.range_offset_sigma_m);
  text += fmt::format("conditioning       {:.0f} (1 is ideal, over 1000 boards are too much alike)\n",
                      e.condition);
  if (e.alternatives.empty()) {
    text += "other minima       none found\n";
  } else {
    text += fmt::format("other minima       {}, the best with {:.1f} px\n", e.alternatives.size(),
                        e.alternatives[0].rmse_px);
  }
  text += "\n" + board_lines(e);
  for (const SceneResult& scene : calibration.scenes) {
    if (!scene.refused.empty()) text += fmt::format("{:24} left out: {}\n", scene.name, scene.refused);
  }
  text += "\nFurther boards that would help most (largest 1 sigma afterwards):\n";
  for (const Advice& advice : calibration.advice) {
    text += fmt::format("  {}: {:.4f} deg, {:.2f} mm\n", advice.pose, advice.rotation_sigma_deg,
                        1e3 * advice.translation_sigma_m);
  }
  return text;
}

std::string lidar_report_json(const LidarCalibration& calibration) {
  const Extrinsics& e = calibration.extrinsics;
  nlohmann::json json;
  json["T_cam_lidar"] = matrix_rows(e.T_camera_lidar);
  std::vector<std::vector<double>> covariance(6, std::vector<double>(6));
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6; ++c)
      covariance[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)] = e.covariance(r, c);
  }
  json["covariance"] = covariance;
  json["rmse_px"] = e.rmse_px;
  json["camera_noise_px"] = e.camera_noise_px;
  json["excess"] = e.excess;
  json["range_offset_m"] = e.range_offset_m;
  json["range_offset_sigma_m"] = e.range_offset_sigma_m;
  json["condition"] = e.condition;
  for (const BoardResult& b : e.boards) {
    json["boards"].push_back({{"name", b.name},
                              {"rmse_px", b.rmse_px},
                              {"distance_m", b.distance_m},
                              {"tilt_deg", b.tilt_deg},
                              {"used", b.used},
                              {"reason", b.reason}});
  }
  for (const SceneResult& scene : calibration.scenes) {
    if (!scene.refused.empty()) json["refused"].push_back({{"name", scene.name}, {"reason", scene.refused}});
  }
  for (const Alternative& a : e.alternatives)
    json["other_minima"].push_back({{"T_cam_lidar", matrix_rows(a.T_camera_lidar)}, {"rmse_px", a.rmse_px}});
  for (const Advice& a : calibration.advice) {
    json["advice"].push_back({{"pose", a.pose},
                              {"rotation_sigma_deg", a.rotation_sigma_deg},
                              {"translation_sigma_m", a.translation_sigma_m}});
  }
  return json.dump(2) + "\n";
}

cv::Mat draw_scene(const SceneResult& scene, const Chessboard& board, const RigCamera& camera,
                   const Eigen::Isometry3d& T_camera_lidar) {
  cv::Mat lidar = to_bgr(scene.lidar_image.reflectivity);
  constexpr double kScale = 3;
  const auto enlarge = [](const cv::Mat& image, const cv::Rect& box) {
    cv::Mat large;
    cv::resize(image(box), large, {}, kScale, kScale, cv::INTER_LINEAR);
    return large;
  };
  const auto moved = [](Corners corners, const cv::Rect& box) {
    for (cv::Point2f& c : corners) c = (c - cv::Point2f(box.tl()) + cv::Point2f(0.5F, 0.5F)) * kScale;
    return corners;
  };
  const cv::Rect lidar_box =
      scene.lidar_corners ? around(*scene.lidar_corners, lidar.size()) : cv::Rect({}, lidar.size());
  cv::Mat left = enlarge(lidar, lidar_box);
  if (scene.lidar_corners)
    cv::drawChessboardCorners(left, board.size(), moved(*scene.lidar_corners, lidar_box), true);

  const cv::Mat image = to_bgr(scene.scene.image);
  const cv::Rect box =
      scene.camera_corners ? around(*scene.camera_corners, image.size()) : cv::Rect({}, image.size());
  cv::Mat right = enlarge(image, box);
  cv::Mat corners = right.clone();
  if (scene.camera_corners)
    cv::drawChessboardCorners(corners, board.size(), moved(*scene.camera_corners, box), true);
  draw_points(right, kScale, box, scene, camera.camera, T_camera_lidar);
  cv::Mat picture;
  cv::hconcat(std::vector<cv::Mat>{panel(left, "LiDAR reflectivity"), panel(corners, "camera"),
                                   panel(right, "LiDAR points in the camera")},
              picture);
  return picture;
}

void write_lidar_report(const std::filesystem::path& folder, const LidarCalibration& calibration,
                        const Chessboard& board) {
  write_file_atomically(folder / "report.txt", format_lidar_report(calibration));
  write_file_atomically(folder / "report.json", lidar_report_json(calibration));
  for (const SceneResult& scene : calibration.scenes) {
    const std::filesystem::path path = folder / (scene.name + ".png");
    write_picture(path,
                  draw_scene(scene, board, calibration.rig.cam0, calibration.extrinsics.T_camera_lidar));
  }
}

}  // namespace alight
