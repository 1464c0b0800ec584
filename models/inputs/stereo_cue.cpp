#include "models/inputs/stereo_cue.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "models/layers/box_mean.hpp"
#include "models/layers/planes.hpp"

namespace alight {
namespace {

namespace F = torch::nn::functional;
constexpr int kScales = 3;
constexpr std::int64_t kWindow_px = 9;
constexpr std::int64_t kLocalMean_px = 15;  // cameras differ in brightness; what is left of it is no parallax
/// Variance of the noise in a window's mean product over that of ln(depth / prior) on real ground: the ridge term.
constexpr double kRidge = 1e-4;
constexpr double kLargestCue = 1.5;

torch::Tensor grey(const torch::Tensor& image) { return image.mean(1, /*keepdim=*/true); }

/// Central difference along rows, 0 at the border.
torch::Tensor horizontal_gradient(const torch::Tensor& x) {
  const std::int64_t width = x.size(3);
  const torch::Tensor inner = 0.5 * (x.slice(3, 2, width) - x.slice(3, 0, width - 2));
  return torch::constant_pad_nd(inner, {1, 1, 0, 0}, 0);
}

struct WarpedRight {
  torch::Tensor image;  // [B,1,H,W]
  torch::Tensor valid;  // [B,1,H,W], 1 where the pixel lies inside the right image
};

/// right(u - disparity, v)
WarpedRight warp(const torch::Tensor& right, const torch::Tensor& disparity_px) {
  const std::int64_t height = right.size(2);
  const std::int64_t width = right.size(3);
  const torch::Tensor u = torch::arange(width, right.options()).view({1, 1, -1}) - disparity_px.squeeze(1);
  const torch::Tensor v = torch::arange(height, right.options()).view({1, -1, 1}).expand_as(u);
  const torch::Tensor grid = torch::stack(
      {u * (2.0 / static_cast<double>(width - 1)) - 1.0, v * (2.0 / static_cast<double>(height - 1)) - 1.0},
      3);
  const auto options =
      F::GridSampleFuncOptions().mode(torch::kBilinear).padding_mode(torch::kBorder).align_corners(true);
  return {F::grid_sample(right, grid, options), (u >= 0).unsqueeze(1).to(right.dtype())};
}

/// Estimate and weight at one scale. @param disparity_px in pixels of this scale
std::vector<torch::Tensor> cue_at_scale(const torch::Tensor& left, const torch::Tensor& warped,
                                        const torch::Tensor& valid, const torch::Tensor& disparity_px) {
  const torch::Tensor a = left - box_mean(left, kLocalMean_px);
  const torch::Tensor b = warped - box_mean(warped, kLocalMean_px);
  const torch::Tensor slope = 0.5 * (horizontal_gradient(a) + horizontal_gradient(b)) * valid;
  const torch::Tensor slope_square = box_mean(slope * slope, kWindow_px);
  const torch::Tensor slope_change = box_mean(slope * (b - a) * valid, kWindow_px);
  const torch::Tensor information = slope_square * disparity_px * disparity_px;
  const torch::Tensor scale = 1.0 / (information + kRidge);
  return {(slope_change * disparity_px * scale).clamp(-kLargestCue, kLargestCue), information * scale};
}

/// The same on planes, into planes of the finest scale's size.
void cue_at_scale(const cv::Mat& left, const cv::Mat& warped, const cv::Mat& valid,
                  const cv::Mat& disparity_px, cv::Mat estimate_out, cv::Mat weight_out) {
  const cv::Mat a = left - box_mean(left, kLocalMean_px);
  const cv::Mat b = warped - box_mean(warped, kLocalMean_px);
  const int width = left.cols;
  cv::Mat slope_square = cv::Mat::zeros(left.size(), CV_32FC1);
  cv::Mat slope_change = cv::Mat::zeros(left.size(), CV_32FC1);
  for (int v = 0; v < left.rows; ++v) {
    const auto *a_row = a.ptr<float>(v), *b_row = b.ptr<float>(v), *valid_row = valid.ptr<float>(v);
    auto *square = slope_square.ptr<float>(v), *change = slope_change.ptr<float>(v);
    for (int u = 1; u + 1 < width; ++u) {
      const float slope =
          0.25F * ((a_row[u + 1] - a_row[u - 1]) + (b_row[u + 1] - b_row[u - 1])) * valid_row[u];
      square[u] = slope * slope;
      change[u] = slope * (b_row[u] - a_row[u]) * valid_row[u];
    }
  }
  cv::Mat estimate = box_mean(slope_change, static_cast<int>(kWindow_px));
  cv::Mat weight = box_mean(slope_square, static_cast<int>(kWindow_px));
  constexpr auto kLargest = static_cast<float>(kLargestCue);
  for (int v = 0; v < left.rows; ++v) {
    const auto* disparity = disparity_px.ptr<float>(v);
    auto *estimate_row = estimate.ptr<float>(v), *weight_row = weight.ptr<float>(v);
    for (int u = 0; u < width; ++u) {
      const float information = weight_row[u] * disparity[u] * disparity[u];
      const float scale = 1.0F / (information + static_cast<float>(kRidge));
      estimate_row[u] = std::clamp(estimate_row[u] * disparity[u] * scale, -kLargest, kLargest);
      weight_row[u] = information * scale;
    }
  }
  cv::resize(estimate, estimate_out, estimate_out.size(), 0, 0, cv::INTER_LINEAR);
  cv::resize(weight, weight_out, weight_out.size(), 0, 0, cv::INTER_LINEAR);
}

torch::Tensor pool(const torch::Tensor& x, int factor) {
  return factor == 1 ? x : torch::avg_pool2d(x, factor, factor, 0, /*ceil_mode=*/true);
}

torch::Tensor enlarge(const torch::Tensor& x, std::int64_t height, std::int64_t width) {
  if (x.size(2) == height && x.size(3) == width) return x;
  return F::interpolate(x, F::InterpolateFuncOptions()
                               .size(std::vector<std::int64_t>{height, width})
                               .mode(torch::kBilinear)
                               .align_corners(false));
}

/// Mean of the three colours of one image of [B,3,H,W].
cv::Mat grey_plane(const torch::Tensor& image, std::int64_t sample) {
  return (plane_of(image, sample, 0) + plane_of(image, sample, 1) + plane_of(image, sample, 2)) / 3;
}

/// right(u - disparity, v) and where that lies inside: rectified cameras differ along rows alone.
void warp_rows(const cv::Mat& right, const cv::Mat& disparity_px, cv::Mat& image, cv::Mat& inside) {
  image.create(right.size(), CV_32FC1);
  inside.create(right.size(), CV_32FC1);
  const auto last = static_cast<float>(right.cols - 1);
  for (int v = 0; v < right.rows; ++v) {
    const auto *row = right.ptr<float>(v), *disparity = disparity_px.ptr<float>(v);
    auto *out = image.ptr<float>(v), *inside_row = inside.ptr<float>(v);
    for (int u = 0; u < right.cols; ++u) {
      const float u_right = static_cast<float>(u) - disparity[u];
      const float at = std::clamp(u_right, 0.0F, last);
      const int before = std::min(static_cast<int>(at), right.cols - 2);
      const float share = at - static_cast<float>(before);
      out[u] = (1 - share) * row[before] + share * row[before + 1];
      inside_row[u] = u_right >= 0 ? 1.0F : 0.0F;
    }
  }
}

/// One sample's cues into planes of `cues`.
void cue_planes(const torch::Tensor& left, const torch::Tensor& right, const torch::Tensor& prior_m,
                float focal_baseline_px_m, std::int64_t sample, const torch::Tensor& cues) {
  const cv::Mat prior = plane_of(prior_m, sample, 0);
  cv::Mat disparity_px(prior.size(), CV_32FC1), known(prior.size(), CV_32FC1);
  for (int v = 0; v < prior.rows; ++v) {
    const auto* depth = prior.ptr<float>(v);
    auto *disparity = disparity_px.ptr<float>(v), *known_row = known.ptr<float>(v);
    for (int u = 0; u < prior.cols; ++u) {
      known_row[u] = depth[u] > 0 ? 1.0F : 0.0F;
      disparity[u] = depth[u] > 0 ? focal_baseline_px_m / depth[u] : 0.0F;
    }
  }
  const cv::Mat left_grey = grey_plane(left, sample);
  cv::Mat warped, valid;
  warp_rows(grey_plane(right, sample), disparity_px, warped, valid);
  cv::multiply(valid, known, valid);
  for (int scale = 0; scale < kScales; ++scale) {
    const int factor = 1 << scale;
    const cv::Mat disparity = shrink(disparity_px, factor) / factor;
    cue_at_scale(shrink(left_grey, factor), shrink(warped, factor), shrink(valid, factor), disparity,
                 plane_of(cues, sample, 2 * scale), plane_of(cues, sample, 2 * scale + 1));
  }
}

torch::Tensor cues_on_planes(const torch::Tensor& left, const torch::Tensor& right,
                             const torch::Tensor& prior_m, const torch::Tensor& focal_baseline_px_m) {
  torch::Tensor cues = torch::zeros({left.size(0), kStereoCueChannels, left.size(2), left.size(3)});
  for (std::int64_t sample = 0; sample < left.size(0); ++sample) {
    if (right[sample].max().item<float>() <= 0) continue;  // there is none
    cue_planes(left, right, prior_m, focal_baseline_px_m[sample].item<float>(), sample, cues);
  }
  return cues;
}

}  // namespace

torch::Tensor stereo_cue(const torch::Tensor& left, const torch::Tensor& right, const torch::Tensor& prior_m,
                         const torch::Tensor& focal_baseline_px_m) {
  const bool shapes = left.dim() == 4 && left.sizes() == right.sizes() && prior_m.dim() == 4 &&
                      prior_m.size(1) == 1 && prior_m.sizes().slice(2) == left.sizes().slice(2) &&
                      focal_baseline_px_m.sizes().equals({left.size(0)});
  if (!shapes || left.size(2) < 8 || left.size(3) < 8) {
    throw std::invalid_argument(
        "stereo_cue: expected left and right [B,3,H,W] of 8 px and more, prior_m [B,1,H,W], focal_baseline "
        "[B]");
  }
  if (has_planes(left) && has_planes(right) && has_planes(prior_m)) {
    return cues_on_planes(left.contiguous(), right.contiguous(), prior_m.contiguous(),
                          focal_baseline_px_m.to(torch::kCPU, torch::kFloat32));
  }
  const torch::Tensor known = (prior_m > 0).to(prior_m.dtype());
  const torch::Tensor disparity_px = known * focal_baseline_px_m.view({-1, 1, 1, 1}) /
                                     torch::where(prior_m > 0, prior_m, torch::ones_like(prior_m));
  const torch::Tensor there = (right.amax({1, 2, 3}, /*keepdim=*/true) > 0).to(left.dtype());  // [B,1,1,1]
  const torch::Tensor left_grey = grey(left);
  const WarpedRight warped = warp(grey(right), disparity_px);
  const torch::Tensor valid = warped.valid * known * there;
  std::vector<torch::Tensor> channels;
  for (int scale = 0; scale < kScales; ++scale) {
    const int factor = 1 << scale;
    for (const torch::Tensor& channel :
         cue_at_scale(pool(left_grey, factor), pool(warped.image, factor), pool(valid, factor),
                      pool(disparity_px, factor) / factor)) {
      channels.push_back(enlarge(channel, left.size(2), left.size(3)));
    }
  }
  return torch::cat(channels, 1);
}

}  // namespace alight
