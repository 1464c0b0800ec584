#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "calibrate/clocks/clock_alignment.hpp"
#include "calibrate/clocks/flight_views.hpp"

namespace alight {

/// A point of one image found in the next one.
struct FollowedPoint {
  Eigen::Vector3d p_camera;  ///< at the first image, by the LiDAR
  Eigen::Vector2d found;     ///< pixel in the second image
};

/// Two images that follow each other, and what was found of the first in the second.
struct ViewPair {
  std::int64_t begin_ns = 0;
  std::int64_t end_ns = 0;
  std::vector<FollowedPoint> points;
};

/// Follows patches at LiDAR points from each image to the next, around the place where poses shifted by `offset_ns` expect
/// them. Pairs with hardly any are left out. @param max_points a pair
std::vector<ViewPair> follow_views(const FlightViews& flight, double points_window_s, std::int64_t offset_ns,
                                   std::size_t max_points);

/// What turn the poses leave unexplained between images, as a function of the camera's clock offset.
class TurnResiduals {
 public:
  /// Pairs are left out that are without a pose at an offset of up to `max_offset_s`, and those most of whose points no single
  /// turn explains: patches that look alike by chance.
  /// @param followed_ns the offset with which they were followed. @param smooth_s poses are averaged over so long to either side
  TurnResiduals(const FlightViews& flight, const std::vector<ViewPair>& pairs, std::int64_t followed_ns,
                double smooth_s, double max_offset_s);

  std::size_t pairs() const { return pairs_.size(); }

  /// Of each pair, how small the turn left over is (Cauchy's robust cost of its length, negative).
  std::vector<double> scores(std::int64_t offset_ns) const;
  /// What images and poses say, at an offset.
  std::vector<ViewTurn> turns(std::int64_t offset_ns) const;

 private:
  struct Left {
    Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();   ///< left over
    Eigen::Vector3d posed_rad = Eigen::Vector3d::Zero();  ///< explained
  };
  Left left_over(const ViewPair& pair, std::int64_t offset_ns) const;
  bool explained(const ViewPair& pair, std::int64_t offset_ns) const;

  PinholeIntrinsics intrinsics_;
  Eigen::Isometry3d T_camera_imu_;
  Trajectory trajectory_{0.25};
  std::vector<ViewPair> pairs_;
  double scale_rad_ = 1;
};

}  // namespace alight
