#include "infer/landing/ground/overhang.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace alight {

cv::Mat ground_beneath(const cv::Mat& level_depth_m, const cv::Mat& obstacles,
                       const PinholeIntrinsics& intrinsics, double clearance_m) {
  cv::Mat beneath = cv::Mat::zeros(level_depth_m.size(), CV_8UC1);
  double deepest_m = 0;
  cv::minMaxLoc(level_depth_m, nullptr, &deepest_m);
  for (int v = 0; v < level_depth_m.rows; ++v) {
    for (int u = 0; u < level_depth_m.cols; ++u) {
      if (obstacles.at<std::uint8_t>(v, u) == 0) continue;
      const double top_m = static_cast<double>(level_depth_m.at<float>(v, u));
      if (top_m <= 0) continue;
      // The column below the point runs through the image towards the centre: follow it down to the first surface.
      const Eigen::Vector3d ray = intrinsics.ray(u, v);
      const double step_m = clearance_m / 2;
      for (double z_m = top_m + clearance_m; z_m <= deepest_m + step_m; z_m += step_m) {
        const Eigen::Vector2d pixel = intrinsics.project({ray.x() * top_m, ray.y() * top_m, z_m});
        if (!intrinsics.contains(pixel.x(), pixel.y())) break;  // a principal point outside the image
        const int u_z = static_cast<int>(pixel.x() + 0.5);
        const int v_z = static_cast<int>(pixel.y() + 0.5);
        const double seen_m = static_cast<double>(level_depth_m.at<float>(v_z, u_z));
        if (std::abs(seen_m - z_m) > step_m) continue;  // air, or hidden behind something nearer
        beneath.at<std::uint8_t>(v_z, u_z) = 255;
        break;
      }
    }
  }
  cv::dilate(beneath, beneath, cv::Mat::ones(3, 3, CV_8UC1));  // closes the gaps between neighbouring columns
  return beneath;
}

cv::Mat columns_in_view(const ElevationRaster& raster, const PinholeIntrinsics& intrinsics,
                        const Eigen::Isometry3d& T_world_camera, double column_m) {
  cv::Mat seen = cv::Mat::zeros(raster.size(), CV_8UC1);
  const Eigen::Isometry3d T_camera_world = T_world_camera.inverse();
  for (int row = 0; row < seen.rows; ++row) {
    for (int column = 0; column < seen.cols; ++column) {
      if (raster.known.at<std::uint8_t>(row, column) == 0) continue;
      const Eigen::Vector2d centre_m = raster.centre_m(column, row);
      // The foot is in view; a column is straight, so is its image: with its top all of it is.
      const Eigen::Vector3d top =
          T_camera_world *
          Eigen::Vector3d(centre_m.x(), centre_m.y(),
                          static_cast<double>(raster.mean_m.at<float>(row, column)) + column_m);
      if (top.z() <= 0) continue;
      const Eigen::Vector2d px = intrinsics.project(top);
      if (intrinsics.contains(px.x(), px.y())) seen.at<std::uint8_t>(row, column) = 255;
    }
  }
  return seen;
}

}  // namespace alight
