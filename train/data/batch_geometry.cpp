#include "train/data/batch_geometry.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace alight {
namespace {

void check_one(const Batch& sample) {
  if (sample.left.dim() != 4 || sample.left.size(0) != 1) {
    throw std::invalid_argument("batch geometry: expected a batch of one sample");
  }
}

template <class Move>
void move_pixels(Batch& sample, const Move& move) {
  for (torch::Tensor* plane :
       {&sample.left, &sample.right, &sample.previous, &sample.next, &sample.sparse_m, &sample.offset_s}) {
    *plane = move(*plane);
  }
}

/// Poses and attitude in other axes of every camera. @param axes [3,3] orthogonal, old coordinates -> new
void change_axes(Batch& sample, const torch::Tensor& axes) {
  torch::Tensor T_new_old = torch::eye(4);
  T_new_old.slice(0, 0, 3).slice(1, 0, 3).copy_(axes);
  for (torch::Tensor* T : {&sample.T_previous_camera, &sample.T_next_camera}) {
    *T = T_new_old.matmul(*T).matmul(T_new_old.t());
  }
  sample.down_camera = sample.down_camera.matmul(axes.t());
}

/// `dimension` 3 mirrors the columns and x, 2 the rows and y.
void mirror(Batch& sample, std::int64_t dimension) {
  const std::int64_t axis = 3 - dimension;
  move_pixels(sample, [&](const torch::Tensor& plane) { return plane.flip(dimension); });
  torch::Tensor axes = torch::eye(3);
  axes[axis][axis] = -1;
  change_axes(sample, axes);
  sample.intrinsics_px = sample.intrinsics_px.clone();
  torch::Tensor centre_px = sample.intrinsics_px.select(1, 2 + axis);
  centre_px.copy_(static_cast<double>(sample.left.size(dimension) - 1) - centre_px);
}

/// Mirrored along the main diagonal, x and y exchanged.
void transpose(Batch& sample) {
  move_pixels(sample, [](const torch::Tensor& plane) { return plane.transpose(2, 3).contiguous(); });
  change_axes(sample, torch::eye(3).index_select(0, torch::tensor({1, 0, 2})));
  sample.intrinsics_px = sample.intrinsics_px.index_select(1, torch::tensor({1, 0, 3, 2}));
}

void drop_right(Batch& sample) {
  sample.right = torch::zeros_like(sample.right);
  sample.has_right = torch::zeros_like(sample.has_right);
}

/// The points where the right camera of the rectified pair sees them, at the same plane depth.
void move_points_to_right(Batch& sample) {
  const double focal_baseline_px_m =
      sample.intrinsics_px[0][0].item<double>() * sample.baseline_m[0].item<double>();
  torch::Tensor moved_m = torch::zeros_like(sample.sparse_m);
  torch::Tensor moved_s = torch::zeros_like(sample.offset_s);
  const auto from_m = sample.sparse_m.accessor<float, 4>()[0][0];
  const auto from_s = sample.offset_s.accessor<float, 4>()[0][0];
  auto to_m = moved_m.accessor<float, 4>()[0][0];
  auto to_s = moved_s.accessor<float, 4>()[0][0];
  // Of points that meet in a pixel, one further right came by a larger disparity: going right, the nearest is last.
  for (std::int64_t v = 0; v < from_m.size(0); ++v) {
    for (std::int64_t u = 0; u < from_m.size(1); ++u) {
      const float z_m = from_m[v][u];
      if (!(z_m > 0)) continue;
      const double right_u = std::round(static_cast<double>(u) - focal_baseline_px_m / z_m);
      if (right_u < 0 || right_u >= static_cast<double>(from_m.size(1))) continue;
      const auto to = static_cast<std::int64_t>(right_u);
      to_m[v][to] = z_m;
      to_s[v][to] = from_s[v][u];
    }
  }
  sample.sparse_m = moved_m;
  sample.offset_s = moved_s;
}

/// The right camera becomes the left one; the other one then lies at -x, until the columns are mirrored.
void swap_cameras(Batch& sample) {
  move_points_to_right(sample);
  std::swap(sample.left, sample.right);
  torch::Tensor T_left_right = torch::eye(4);
  T_left_right[0][3] = sample.baseline_m[0];
  sample.T_previous_camera = sample.T_previous_camera.matmul(T_left_right);
  sample.T_next_camera = sample.T_next_camera.matmul(T_left_right);
  sample.height_m = sample.height_m - sample.baseline_m * sample.down_camera.select(1, 0);
}

}  // namespace

Batch flip_horizontally(Batch sample) {
  check_one(sample);
  if (sample.has_right[0].item<bool>()) swap_cameras(sample);
  mirror(sample, 3);
  return sample;
}

Batch flip_vertically(Batch sample) {
  check_one(sample);
  mirror(sample, 2);
  return sample;
}

Batch turn(Batch sample, int quarter_turns) {
  check_one(sample);
  if (sample.left.size(2) != sample.left.size(3) || quarter_turns < 1 || quarter_turns > 3) {
    throw std::invalid_argument("turn: expected square images and 1, 2 or 3 quarter turns");
  }
  if (quarter_turns == 2) return flip_vertically(flip_horizontally(std::move(sample)));
  drop_right(sample);
  transpose(sample);
  mirror(sample, quarter_turns == 1 ? 2 : 3);
  return sample;
}

}  // namespace alight
