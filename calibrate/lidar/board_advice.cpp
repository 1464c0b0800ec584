#include "calibrate/lidar/board_advice.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>
#include <fmt/format.h>

#include "calibrate/lidar/joint_refinement.hpp"
#include "geometry/frames.hpp"

namespace alight {
namespace {

using Eigen::Vector3d;

struct Tilt {
  const char* words;
  Vector3d axis;  // camera frame
  double deg;
};

const std::array<Tilt, 5> kTilts = {Tilt{"facing the camera", Vector3d::UnitX(), 0},
                                    {"its right side turned away by 35 deg", Vector3d::UnitY(), -35},
                                    {"its left side turned away by 35 deg", Vector3d::UnitY(), 35},
                                    {"its top leaning away by 35 deg", Vector3d::UnitX(), -35},
                                    {"its bottom leaning away by 35 deg", Vector3d::UnitX(), 35}};
const std::array<const char*, 3> kColumns = {"left", "middle", "right"};
const std::array<const char*, 3> kRows = {"upper", "central", "lower"};

/// The extrinsics' covariance with one more board.
Matrix6d with_board(const Matrix6d& covariance, const Matrix6d& information) {
  return (covariance.inverse() + information).inverse();
}

double largest_scaled_sigma(const Matrix6d& covariance, double distance_m) {
  const Vector6d sigma = covariance.diagonal().cwiseSqrt();
  return std::max(sigma.head<3>().maxCoeff(), distance_m * sigma.tail<3>().maxCoeff());
}

}  // namespace

std::vector<Advice> advise_poses(const Chessboard& board, const std::vector<BoardView>& views,
                                 const Extrinsics& extrinsics, const PinholeIntrinsics& intrinsics,
                                 const ExtrinsicsConfig& config) {
  constexpr std::size_t kShown = 3;
  if (views.empty()) return {};
  // The LiDAR sees a new board as well as it did on average, and the boards so far tell which angles it can reach.
  BoardView next;
  next.pixels.assign(static_cast<std::size_t>(board.corners()),
                     {0, 0});  // what they tell does not depend on them
  double reach = 1;
  double near_m = 1e9;
  double far_m = 0;
  for (const BoardView& view : views) {
    next.lidar.covariance += view.lidar.covariance / static_cast<double>(views.size());
    const Vector3d centre = view.lidar.T_lidar_board * board.centre();
    reach = std::min(reach, centre.normalized().x());
    near_m = std::min(near_m, centre.norm());
    far_m = std::max(far_m, centre.norm());
  }
  const JointNoise noise{extrinsics.camera_noise_px, config.range_bias_m, to_radians(config.angle_bias_deg)};
  std::vector<std::pair<double, Advice>> ranked;
  for (const double distance_m : {near_m, 0.5 * (near_m + far_m)}) {
    for (std::size_t row = 0; row < kRows.size(); ++row) {
      for (std::size_t column = 0; column < kColumns.size(); ++column) {
        const Vector3d ray = intrinsics.ray(intrinsics.width_px * (0.2 + 0.3 * static_cast<double>(column)),
                                            intrinsics.height_px * (0.2 + 0.3 * static_cast<double>(row)));
        const Vector3d centre = ray.normalized() * distance_m;
        if ((extrinsics.T_camera_lidar.inverse() * centre).normalized().x() < reach) continue;
        for (const Tilt& tilt : kTilts) {
          Eigen::Isometry3d T_camera_board(Eigen::Translation3d{centre});
          T_camera_board.rotate(Eigen::AngleAxisd(to_radians(tilt.deg), tilt.axis));
          next.lidar.T_lidar_board =
              extrinsics.T_camera_lidar.inverse() * T_camera_board * Eigen::Translation3d(-board.centre());
          const Matrix6d after =
              with_board(extrinsics.covariance,
                         board_information(board, next, extrinsics.T_camera_lidar, intrinsics, noise));
          const Vector6d sigma = after.diagonal().cwiseSqrt();
          const std::string text = fmt::format("{:.1f} m away in the {} {} of the image, {}", distance_m,
                                               kRows[row], kColumns[column], tilt.words);
          ranked.push_back({largest_scaled_sigma(after, distance_m),
                            {text, to_degrees(sigma.tail<3>().maxCoeff()), sigma.head<3>().maxCoeff()}});
        }
      }
    }
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Advice> result;
  for (std::size_t i = 0; i < std::min(kShown, ranked.size()); ++i) result.push_back(ranked[i].second);
  return result;
}

}  // namespace alight
