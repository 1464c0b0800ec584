#pragma once

#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include "calibrate/clocks/flight_views.hpp"
#include "geometry/camera.hpp"

namespace alight {

/// How strong the image's edges are: gradient over the mean gradient around, so that a lawn counts no more than a road.
/// @param grey CV_8UC1. @returns CV_8UC1, 64 = as strong as the surroundings, saturated at nearly four times that
cv::Mat edge_strength(const cv::Mat& grey);

/// How well a LiDAR's depth edges lie on the edges of images: the mean strength of the image where the LiDAR's edges fall,
/// in units of the strength around. 1 is chance. (Levinson and Thrun 2013, with the vehicle's motion.)
class EdgeAgreement {
 public:
  /// @param intrinsics of the images. @param margin_px how near to the border a point may lie
  EdgeAgreement(const PinholeIntrinsics& intrinsics, int margin_px);

  /// Points that fall outside the image or nearer to its border than the margin are left out.
  void add_view(const cv::Mat& strength, const std::vector<SeenPoint>& points);

  std::size_t views() const { return views_.size(); }
  std::size_t points() const { return points_; }
  std::size_t points_of(std::size_t view) const { return views_[view].points.size(); }

  /// Of each view, the sum of the strengths over the number of all points, once the LiDAR was moved in the camera's frame:
  /// T_camera_lidar = motion * (what the points were made with). They add up to the score.
  /// @param every_nth only these points of each view count
  std::vector<double> scores(const Eigen::Isometry3d& motion, std::size_t every_nth = 1) const;

  /// The pixels of a view's points at a motion.
  std::vector<Eigen::Vector2d> pixels(std::size_t view, const Eigen::Isometry3d& motion) const;

 private:
  struct View {
    cv::Mat strength;
    std::vector<SeenPoint> points;
  };
  PinholeIntrinsics intrinsics_;
  double margin_px_;
  std::vector<View> views_;
  std::size_t points_ = 0;
};

}  // namespace alight
