#pragma once

#include <Eigen/Core>

namespace alight {

/// Where a search is after so much way: an Archimedean spiral from the middle outwards to the fence, then inwards turning
/// on in the same sense, and so on; every return to the middle leaves it turned by the golden angle, so that no pass
/// follows another, and none leaves the fence.
class WanderPath {
 public:
  /// @param radius_m of the fence  @param spacing_m between the turns of a pass. Both positive.
  WanderPath(double radius_m, double spacing_m);

  /// Offset from the middle, metres. @param way_m 0 or more
  Eigen::Vector2d at(double way_m) const;
  /// Length of one pass.
  double pass_m() const { return pass_m_; }

 private:
  double radius_m_;
  double pitch_m_;  // per radian
  double pass_m_;
};

}  // namespace alight
