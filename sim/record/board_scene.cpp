#include "sim/record/board_scene.hpp"

#include <array>
#include <cmath>

#include "foundation/config_reader.hpp"
#include "foundation/errors.hpp"
#include "foundation/shipped_files.hpp"
#include "geometry/frames.hpp"
#include "sim/counter_random.hpp"
#include "sim/record/simulated_flight.hpp"
#include "sim/sensors/livox_scan.hpp"

namespace alight::sim {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Random numbers in the order in which they are asked for.
class Draw {
 public:
  Draw(std::int64_t seed, std::uint64_t purpose)
      : random_(CounterRandom(static_cast<std::uint64_t>(seed), RandomStream::kBoardScene).child(purpose)) {}
  double between(double min, double max) { return random_.uniform(counter_++, min, max); }

 private:
  CounterRandom random_;
  std::uint64_t counter_ = 0;
};

Eigen::AngleAxisd turn(double deg, const Vector3d& axis) { return {to_radians(deg), axis}; }

Eigen::Isometry3d random_mounting(const Eigen::Isometry3d& T_camera_lidar, std::int64_t seed) {
  Draw draw(seed, 1);
  const double quarter_turns = std::floor(draw.between(0, 4));
  Eigen::Isometry3d T = T_camera_lidar;
  T.rotate(turn(90 * quarter_turns + draw.between(-10, 10), Vector3d::UnitX()));  // boresight = x
  T.rotate(turn(draw.between(-4, 4), Vector3d::UnitY()));
  T.rotate(turn(draw.between(-4, 4), Vector3d::UnitZ()));
  for (int axis = 0; axis < 3; ++axis) T.translation()[axis] += draw.between(-0.15, 0.15);
  return T;
}

/// The corners of the board's paper, in the board's frame.
std::array<Vector3d, 4> paper_corners(const PrintedBoard& board) {
  const double low = -board.square_m - board.margin_m;
  const double right = board.columns * board.square_m + board.margin_m;
  const double bottom = board.rows * board.square_m + board.margin_m;
  return {Vector3d(low, low, 0), {right, low, 0}, {right, bottom, 0}, {low, bottom, 0}};
}

bool both_sensors_see(const PrintedBoard& board, const RectifiedRig& rig,
                      const Eigen::Isometry3d& T_camera_board) {
  constexpr double kEdge_rad = 0.012;
  constexpr double kEdge_px = 6;
  for (const Vector3d& corner : paper_corners(board)) {
    const Vector3d p_camera = T_camera_board * corner;
    const Vector3d p_lidar = rig.T_camera_lidar.inverse() * p_camera;
    if (p_camera.z() < 0.5 || p_lidar.x() < 0.5) return false;
    if (std::acos(p_lidar.normalized().x()) > kLivoxHalfFov_rad - kEdge_rad) return false;
    const Eigen::Vector2d pixel = rig.intrinsics.project(p_camera);
    if (pixel.minCoeff() < kEdge_px || pixel.x() > rig.intrinsics.width_px - 1 - kEdge_px ||
        pixel.y() > rig.intrinsics.height_px - 1 - kEdge_px) {
      return false;
    }
  }
  return true;
}

Eigen::Isometry3d random_pose(const BoardSceneConfig& config, const RectifiedRig& rig, Draw& draw) {
  const double distance_m = draw.between(config.min_distance_m, config.max_distance_m);
  const double off_axis_rad = (kLivoxHalfFov_rad - 0.05) * std::sqrt(draw.between(0, 1));
  const double around = draw.between(0, 360);
  const Vector3d direction_lidar(std::cos(off_axis_rad),
                                 std::sin(off_axis_rad) * std::cos(to_radians(around)),
                                 std::sin(off_axis_rad) * std::sin(to_radians(around)));
  const Vector3d centre = rig.T_camera_lidar * Vector3d(distance_m * direction_lidar);
  const double tilt_deg = config.max_tilt_deg * std::sqrt(draw.between(0, 1));
  const double tilt_axis = to_radians(draw.between(0, 360));
  Eigen::Isometry3d T(Eigen::Translation3d{centre});
  T.rotate(Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), centre.normalized()));
  T.rotate(turn(tilt_deg, Vector3d(std::cos(tilt_axis), std::sin(tilt_axis), 0)));
  T.rotate(turn(draw.between(-config.max_roll_deg, config.max_roll_deg), Vector3d::UnitZ()));
  const double half = 0.5 * config.board.square_m;
  return T * Eigen::Translation3d(-half * (config.board.columns - 1), -half * (config.board.rows - 1), 0);
}

}  // namespace

BoardSceneConfig::BoardSceneConfig() {
  sensors.camera.rate_hz = 5;
  sensors.lidar.divergence_up_deg = 0.28;
  sensors.lidar.divergence_across_deg = 0.03;
  sensors.lidar.reflectivity_noise = 4;
  sensors.lidar.angle_error_deg = 0.05;  // half of what the Mid-40's manual allows
  renderer.exposure = 0.42;              // white paper in the sun stays below the sensor's limit
  renderer.edge_samples = 16;
}

void bind(Binder& b, PrintedBoard& c) {
  b.field("columns", c.columns, "inner corners along the longer side", between(2, 50));
  b.field("rows", c.rows, "inner corners along the other side", between(2, 50));
  b.field("square_m", c.square_m, "side of a square", between(0.001, 10));
  b.field("margin_m", c.margin_m, "white around the squares", between(0, 10));
}

void bind(Binder& b, BoardSceneConfig& c) {
  b.field("rig", c.rig, "rig file: sensors, their mounting and topics");
  b.choice("mounting", c.mounting, {{"as_rig", Mounting::kAsRig}, {"random", Mounting::kRandom}},
           "where the LiDAR truly is: as the rig file says, or turned and moved at random");
  b.field("seed", c.seed, "of mounting, board poses and noise", at_least(0));
  b.section("board", c.board, "the printed chessboard");
  b.field("scenes", c.scenes, "recordings, each with the board in another pose", between(1, 1000));
  b.field("duration_s", c.duration_s, "of each recording", between(0.1, 600));
  b.field("min_distance_m", c.min_distance_m, "nearest board", between(0.5, 100));
  b.field("max_distance_m", c.max_distance_m, "farthest board", between(0.5, 100));
  b.field("max_tilt_deg", c.max_tilt_deg, "of the board against facing the sensors", between(0, 60));
  b.field("max_roll_deg", c.max_roll_deg, "of the board about its normal", between(0, 180));
  b.field("lens_blur_px", c.lens_blur_px, "1 sigma of the lens's point spread", between(0, 10));
  b.field("range_bias_m", c.range_bias_m, "1 sigma of a range error of all scenes, and again of one a scene",
          between(0, 1));
  b.field("drift_mps", c.drift_mps, "the rig moves at this speed (0: as it should be)", between(0, 10));
  b.section("sensors", c.sensors, "stereo camera and LiDAR; the others are not recorded");
  b.section("renderer", c.renderer, "how images are made");
  b.check("max_distance_m", c.max_distance_m >= c.min_distance_m, "must not be smaller than min_distance_m");
}

Rig mounted_rig(const BoardSceneConfig& config) {
  Rig rig = load_rig(input_file(config.rig));
  flyable_rig(rig, config.rig);
  if (config.mounting == Mounting::kRandom)
    rig.lidar0->T_camera_lidar = random_mounting(rig.lidar0->T_camera_lidar, config.seed);
  return rig;
}

std::vector<Eigen::Isometry3d> board_poses(const BoardSceneConfig& config, const RectifiedRig& rig) {
  constexpr int kMaxTries = 100000;
  Draw draw(config.seed, 2);
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < kMaxTries && static_cast<int>(poses.size()) < config.scenes; ++k) {
    const Eigen::Isometry3d T_camera_board = random_pose(config, rig, draw);
    if (both_sensors_see(config.board, rig, T_camera_board)) poses.push_back(T_camera_board);
  }
  if (static_cast<int>(poses.size()) < config.scenes) {
    throw ConfigError(
        "board: finds no place where camera and LiDAR see it whole; make it smaller or the distances larger");
  }
  return poses;
}

World board_world(const PrintedBoard& board, const Eigen::Isometry3d& T_world_board) {
  constexpr float kGround_m = 200;
  constexpr std::array<Material, 3> kBoardMaterials = {Material::kGrass, Material::kBoardWhite,
                                                       Material::kBoardBlack};
  std::vector<Surface> surfaces(kBoardMaterials.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) surfaces[i].material = kBoardMaterials[i];
  TriangleMesh mesh;
  mesh.add_quad({-kGround_m, -kGround_m, 0}, {kGround_m, -kGround_m, 0}, {kGround_m, kGround_m, 0},
                {-kGround_m, kGround_m, 0}, 0);
  // One rectangle a square: no crack and no second surface lies behind another. Counter-clockwise as seen from -z.
  const auto rectangle = [&](double left, double top, double right, double bottom, std::uint16_t surface) {
    const auto at = [&](double x, double y) {
      return Vector3f((T_world_board * Vector3d(x, y, 0)).cast<float>());
    };
    mesh.add_quad(at(left, top), at(left, bottom), at(right, bottom), at(right, top), surface);
  };
  const double s = board.square_m;
  for (int row = -1; row < board.rows; ++row) {
    for (int column = -1; column < board.columns; ++column)
      rectangle(column * s, row * s, (column + 1) * s, (row + 1) * s, (row + column) % 2 == 0 ? 2 : 1);
  }
  const double left = -s;
  const double right = board.columns * s;
  const double bottom = board.rows * s;
  const double m = board.margin_m;
  if (m > 0) {
    rectangle(left - m, left - m, right + m, left, 1);
    rectangle(left - m, bottom, right + m, bottom + m, 1);
    rectangle(left - m, left, left, bottom, 1);
    rectangle(right, left, right + m, bottom, 1);
  }
  return World::from_meshes({mesh}, surfaces, 2 * static_cast<double>(kGround_m), {0.2, 0.3, 0.93});
}

}  // namespace alight::sim
