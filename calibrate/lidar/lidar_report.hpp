#pragma once

#include <filesystem>
#include <string>

#include <opencv2/core.hpp>

#include "calibrate/lidar/lidar_calibration.hpp"

namespace alight {

/// The result for a reader: extrinsics with their standard deviations, boards, other minima, advice.
std::string format_lidar_report(const LidarCalibration& calibration);

/// The same as JSON: T_cam_lidar, covariance (translation m, rotation vector rad, camera frame), boards, advice.
std::string lidar_report_json(const LidarCalibration& calibration);

/// The LiDAR's image with the corners found in it beside the camera's image with the LiDAR's points (dark returns blue,
/// bright ones yellow: they have to lie on the like squares) and its corners. Also for a scene that was refused, with
/// what was found. @param T_camera_lidar the calibrated extrinsics. @returns CV_8UC3
cv::Mat draw_scene(const SceneResult& scene, const Chessboard& board, const RigCamera& camera,
                   const Eigen::Isometry3d& T_camera_lidar);

/// report.txt, report.json and a picture a recording into `folder`, which exists. @throws DataError
void write_lidar_report(const std::filesystem::path& folder, const LidarCalibration& calibration,
                        const Chessboard& board);

}  // namespace alight
