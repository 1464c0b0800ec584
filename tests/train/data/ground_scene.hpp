#pragma once

#include <cmath>
#include <cstdint>

#include <torch/torch.h>

#include "losses/training_loss.hpp"
#include "train/data/batch.hpp"

namespace alight::test {

/// Level ground with a smooth texture, seen by a tilted camera: every view and depth in closed form.
struct GroundScene {
  Batch batch;                                ///< one sample
  torch::Tensor left_depth_m, right_depth_m;  ///< [1,1,H,W], everywhere
};

struct GroundSceneOptions {
  std::int64_t height_px = 44;
  std::int64_t width_px = 44;
  bool has_right = true;
  bool level_camera = false;  ///< looks straight down: then all pixels move by exactly 3 between the cameras
};

/// T_view_left of a small turn about all axes and a move.
inline torch::Tensor ground_pose(double turn_rad, double x_m, double y_m, double z_m) {
  const double r = turn_rad;
  const torch::Tensor twist = torch::tensor(
      {{0.0, -r, -r / 2, 0.0}, {r, 0.0, r / 3, 0.0}, {r / 2, -r / 3, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}},
      torch::kFloat64);
  torch::Tensor T = torch::matrix_exp(twist);
  T.select(1, 3).slice(0, 0, 3).copy_(torch::tensor({x_m, y_m, z_m}, torch::kFloat64));
  return T;
}

struct GroundView {
  torch::Tensor image;    // [1,3,H,W]
  torch::Tensor depth_m;  // [1,1,H,W]
};

/// @param T_view_left [4,4] float64 @param down [3] float64, in the left camera; the ground is `height_m` below it
inline GroundView render_ground(const torch::Tensor& T_view_left, const torch::Tensor& down, double height_m,
                                const torch::Tensor& k, const GroundSceneOptions& o) {
  const torch::Tensor u = torch::arange(o.width_px, torch::kFloat64).view({1, -1}).expand({o.height_px, -1});
  const torch::Tensor v = torch::arange(o.height_px, torch::kFloat64).view({-1, 1}).expand({-1, o.width_px});
  const torch::Tensor ray = torch::stack({(u - k[2]) / k[0], (v - k[3]) / k[1], torch::ones_like(u)});
  const torch::Tensor R_left_view = T_view_left.slice(0, 0, 3).slice(1, 0, 3).t();
  const torch::Tensor centre = -R_left_view.matmul(T_view_left.select(1, 3).slice(0, 0, 3));
  const torch::Tensor ray_left = R_left_view.matmul(ray.view({3, -1})).view_as(ray);
  const torch::Tensor z = (height_m - down.dot(centre)) / (down.view({3, 1, 1}) * ray_left).sum(0);
  const torch::Tensor p = centre.view({3, 1, 1}) + z * ray_left;  // [3,H,W] in the left camera
  const auto channel = [&](double phase) {
    return 0.5 + 0.2 * torch::sin(1.7 * p[0] + 0.6 * p[1] + phase) +
           0.15 * torch::sin(1.9 * p[1] - 0.8 * p[0] + 2 * phase);
  };
  return {torch::stack({channel(0), channel(1), channel(2)}).unsqueeze(0).to(torch::kFloat32),
          z.view({1, 1, o.height_px, o.width_px}).to(torch::kFloat32)};
}

inline GroundScene ground_scene(const GroundSceneOptions& o = {}) {
  constexpr double kHeight_m = 10;
  constexpr double kBaseline_m = 0.5;
  torch::manual_seed(4);
  const torch::Tensor k = torch::tensor({60.0, 56.0, 24.25, 19.5}, torch::kFloat64);
  torch::Tensor down = o.level_camera ? torch::tensor({0.0, 0.0, 1.0}, torch::kFloat64)
                                      : torch::tensor({0.2, -0.3, 1.0}, torch::kFloat64);
  down = down / down.norm();
  const auto view = [&](const torch::Tensor& T) { return render_ground(T, down, kHeight_m, k, o); };
  const torch::Tensor T_previous = ground_pose(0.03, 0.5, -0.3, 0.2);
  const torch::Tensor T_next = ground_pose(-0.02, -0.4, 0.4, -0.1);
  const GroundView left = view(torch::eye(4, torch::kFloat64));
  const GroundView right = view(ground_pose(0, -kBaseline_m, 0, 0));
  const auto one = [](const torch::Tensor& x) { return x.unsqueeze(0).to(torch::kFloat32); };
  const auto flag = [](bool x) { return torch::full({1}, x, torch::kBool); };
  Batch b;
  b.left = left.image;
  b.right = o.has_right ? right.image : torch::zeros_like(right.image);
  b.previous = view(T_previous).image;
  b.next = view(T_next).image;
  b.sparse_m = left.depth_m * (torch::rand_like(left.depth_m) < 0.3);
  b.offset_s = b.sparse_m * 0.01;  // tells the points apart
  b.has_right = flag(o.has_right);
  b.has_previous = b.has_next = flag(true);
  b.T_previous_camera = one(T_previous);
  b.T_next_camera = one(T_next);
  b.intrinsics_px = one(k);
  b.baseline_m = torch::full({1}, kBaseline_m);
  b.height_m = torch::full({1}, kHeight_m);
  b.down_camera = one(down);
  b.indices = {7};
  return {b, left.depth_m, right.depth_m};
}

/// The photometric loss of a depth map against some of the sources.
inline double photometric(const Batch& b, const torch::Tensor& depth_m, bool previous, bool next,
                          bool right) {
  TrainingLossConfig config;
  config.depth_weight = config.ratio_weight = config.smoothness_weight = 0;
  config.photometric.use_previous = previous;
  config.photometric.use_next = next;
  config.photometric.use_right = right;
  const LossInputs inputs{
      depth_m,      b.sparse_m,     b.sparse_m, b.left,      b.previous,          b.next,
      b.right,      b.has_previous, b.has_next, b.has_right, b.T_previous_camera, b.T_next_camera,
      b.baseline_m, b.intrinsics_px};
  return TrainingLoss(config)(inputs).photometric.item<double>();
}

}  // namespace alight::test
