#include "calibrate/board/board_plane.hpp"

#include <cmath>
#include <cstdint>

#include <Eigen/Dense>

namespace alight {
namespace {

using Eigen::Vector3d;

constexpr int kMaxPoints = 40000;

Plane plane_through(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d normal = (b - a).cross(c - a).normalized();
  return {normal, normal.dot(a)};
}

Plane least_squares_plane(const std::vector<Beam>& beams, const std::vector<char>& used) {
  Vector3d mean = Vector3d::Zero();
  double count = 0;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (used[i] == 0) continue;
    mean += beams[i].direction * beams[i].range_m;
    ++count;
  }
  mean /= count;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < beams.size(); ++i) {
    if (used[i] == 0) continue;
    const Vector3d d = beams[i].direction * beams[i].range_m - mean;
    scatter += d * d.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  const Vector3d normal = solver.eigenvectors().col(0);
  return {normal, normal.dot(mean)};
}

}  // namespace

std::vector<Beam> beams_of(const std::vector<LidarReturn>& points) {
  const std::size_t step = points.size() / kMaxPoints + 1;
  std::vector<Beam> beams;
  for (std::size_t i = 0; i < points.size(); i += step) {
    const Vector3d p = points[i].p_lidar.cast<double>();
    beams.push_back({p.normalized(), p.norm(), static_cast<double>(points[i].reflectivity)});
  }
  return beams;
}

Plane ransac_plane(const std::vector<Beam>& beams, std::vector<char>& inliers) {
  constexpr int kTrials = 100;
  constexpr double kThreshold_m = 0.06;  // three times the noise of a Livox
  std::uint64_t state = 1;
  const auto random_beam = [&]() -> const Beam& {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return beams[static_cast<std::size_t>(state >> 33U) % beams.size()];
  };
  const auto mark = [&](const Plane& plane, std::vector<char>& out) {
    std::size_t count = 0;
    out.resize(beams.size());
    for (std::size_t i = 0; i < beams.size(); ++i) {
      const bool near = std::abs(plane.range(beams[i].direction) - beams[i].range_m) < kThreshold_m;
      out[i] = near ? 1 : 0;
      count += near ? 1 : 0;
    }
    return count;
  };
  Plane best;
  std::size_t most = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Beam& a = random_beam();
    const Beam& b = random_beam();
    const Beam& c = random_beam();
    const Plane plane =
        plane_through(a.direction * a.range_m, b.direction * b.range_m, c.direction * c.range_m);
    if (!plane.normal.allFinite()) continue;
    const std::size_t count = mark(plane, inliers);
    if (count <= most) continue;
    most = count;
    best = plane;
  }
  for (int k = 0; k < 2 && most >= 3; ++k) {
    mark(best, inliers);
    best = least_squares_plane(beams, inliers);
  }
  mark(best, inliers);
  return best;
}

}  // namespace alight
