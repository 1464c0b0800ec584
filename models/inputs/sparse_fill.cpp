#include "models/inputs/sparse_fill.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "models/layers/box_mean.hpp"
#include "models/layers/planes.hpp"

namespace alight {
namespace {

constexpr double kLeastWeight = 1e-12;

/// Mean of the valid values under a pixel of some level.
template <class Map>
struct Level {
  Map weighted_value;  // share of valid pixels times their mean
  Map weight;          // share of valid pixels
};

/// Half the size. Windows over the edge divide both by the same count, so that their ratio stays a mean.
torch::Tensor half(const torch::Tensor& x) { return torch::avg_pool2d(x, 2, 2, 0, /*ceil_mode=*/true); }
cv::Mat half(const cv::Mat& plane) { return shrink(plane, 2); }

bool is_one_pixel(const torch::Tensor& x) { return x.size(2) == 1 && x.size(3) == 1; }
bool is_one_pixel(const cv::Mat& plane) { return plane.total() == 1; }

template <class Map>
std::vector<Level<Map>> pull(Level<Map> finest) {
  std::vector<Level<Map>> levels{finest};
  while (!is_one_pixel(levels.back().weight))
    levels.push_back({half(levels.back().weighted_value), half(levels.back().weight)});
  return levels;
}

/// Coarseness of a level, 0 for the finest .. 1.
double coarseness_of(std::size_t level, std::size_t levels) {
  return static_cast<double>(level) / static_cast<double>(std::max<std::size_t>(levels - 1, 1));
}

/// Twice the size, cut to that of `like` (whose pyramid was rounded up). Pixel centres stay where they are.
torch::Tensor enlarge(const torch::Tensor& coarse, const torch::Tensor& like) {
  using torch::indexing::None;
  using torch::indexing::Slice;
  const auto options = torch::nn::functional::InterpolateFuncOptions()
                           .scale_factor(std::vector<double>{2.0, 2.0})
                           .mode(torch::kBilinear)
                           .align_corners(false);
  return torch::nn::functional::interpolate(coarse, options)
      .index({Slice(), Slice(), Slice(None, like.size(2)), Slice(None, like.size(3))});
}

cv::Mat enlarge(const cv::Mat& coarse, const cv::Mat& like) {
  cv::Mat fine;
  cv::resize(coarse, fine, coarse.size() * 2, 0, 0, cv::INTER_LINEAR);
  return fine(cv::Rect({}, like.size()));
}

SparseFill push(const std::vector<Level<torch::Tensor>>& levels, int smoothing) {
  SparseFill fill{torch::zeros_like(levels.back().weight), torch::ones_like(levels.back().weight)};
  for (std::size_t i = levels.size(); i-- > 0;) {
    const Level<torch::Tensor>& level = levels[i];
    if (i + 1 < levels.size())
      fill = {enlarge(fill.value, level.weight), enlarge(fill.coarseness, level.weight)};
    const torch::Tensor known = level.weight > 0;
    const torch::Tensor mean = level.weighted_value / level.weight.clamp_min(kLeastWeight);
    fill.value = torch::where(known, mean, fill.value);
    for (int pass = 0; pass < smoothing; ++pass)
      fill.value = torch::where(known, mean, box_mean(fill.value, 3));
    fill.coarseness = torch::where(known, torch::full_like(fill.coarseness, coarseness_of(i, levels.size())),
                                   fill.coarseness);
  }
  return fill;
}

/// A level's own means where it has some.
void set_known(const Level<cv::Mat>& level, float coarseness, cv::Mat& value, cv::Mat& coarse) {
  for (int v = 0; v < value.rows; ++v) {
    const auto* weight = level.weight.ptr<float>(v);
    const auto* weighted = level.weighted_value.ptr<float>(v);
    auto* out = value.ptr<float>(v);
    auto* out_coarseness = coarse.ptr<float>(v);
    for (int u = 0; u < value.cols; ++u) {
      const float mean = weighted[u] / std::max(weight[u], static_cast<float>(kLeastWeight));
      out[u] = weight[u] > 0 ? mean : out[u];
      out_coarseness[u] = weight[u] > 0 ? coarseness : out_coarseness[u];
    }
  }
}

/// Sums of three neighbours of a row; there is nothing beyond its ends.
void sum_of_three(const float* row, int length, float* sums) {
  for (int u = 1; u + 1 < length; ++u) sums[u] = row[u - 1] + row[u] + row[u + 1];
  sums[0] = length > 1 ? row[0] + row[1] : row[0];
  if (length > 1) sums[length - 1] = row[length - 2] + row[length - 1];
}

/// Holes become the mean of their 3x3 neighbourhood, in place: the sums of the row below are taken before a row changes.
void smooth_holes(const cv::Mat& weight, cv::Mat& value) {
  const int width = value.cols, height = value.rows;
  const auto length = static_cast<std::size_t>(width);
  std::vector<float> above(length, 0.0F), here(length), below(length, 0.0F);
  std::vector<float> columns(length, 1.0F / 3);
  columns.front() = columns.back() = width > 1 ? 1.0F / 2 : 1.0F;
  sum_of_three(value.ptr<float>(0), width, here.data());
  for (int v = 0; v < height; ++v) {
    if (v + 1 < height)
      sum_of_three(value.ptr<float>(v + 1), width, below.data());
    else
      std::fill(below.begin(), below.end(), 0.0F);
    const float rows = 1.0F / static_cast<float>(1 + (v > 0 ? 1 : 0) + (v + 1 < height ? 1 : 0));
    const auto* known = weight.ptr<float>(v);
    auto* row = value.ptr<float>(v);
    const float *a = above.data(), *b = here.data(), *c = below.data(), *factors = columns.data();
    for (int u = 0; u < width; ++u) row[u] = known[u] > 0 ? row[u] : (a[u] + b[u] + c[u]) * factors[u] * rows;
    above.swap(here);
    here.swap(below);
  }
}

/// One sample, into planes of the finest level's size.
void push(const std::vector<Level<cv::Mat>>& levels, int smoothing, cv::Mat value_out,
          cv::Mat coarseness_out) {
  cv::Mat value(1, 1, CV_32FC1, cv::Scalar(0)), coarseness(1, 1, CV_32FC1, cv::Scalar(1));
  for (std::size_t i = levels.size(); i-- > 0;) {
    const Level<cv::Mat>& level = levels[i];
    if (i + 1 < levels.size()) {
      value = enlarge(value, level.weight);
      coarseness = enlarge(coarseness, level.weight);
    }
    set_known(level, static_cast<float>(coarseness_of(i, levels.size())), value, coarseness);
    for (int pass = 0; pass < smoothing; ++pass) smooth_holes(level.weight, value);
  }
  value.copyTo(value_out);
  coarseness.copyTo(coarseness_out);
}

SparseFill fill_planes(const torch::Tensor& value, const torch::Tensor& valid, int smoothing) {
  SparseFill fill{torch::empty_like(value), torch::empty_like(value)};
  for (std::int64_t sample = 0; sample < value.size(0); ++sample) {
    push(pull<cv::Mat>({plane_of(value, sample, 0), plane_of(valid, sample, 0)}), smoothing,
         plane_of(fill.value, sample, 0), plane_of(fill.coarseness, sample, 0));
  }
  return fill;
}

}  // namespace

SparseFill fill_pyramid(const torch::Tensor& value, const torch::Tensor& valid, int smoothing) {
  if (value.dim() != 4 || value.size(1) != 1 || value.sizes() != valid.sizes()) {
    throw std::invalid_argument("fill_pyramid: expected value and valid [B,1,H,W]");
  }
  const torch::Tensor known_value = torch::where(valid > 0, value, torch::zeros_like(value));
  if (has_planes(known_value) && has_planes(valid))
    return fill_planes(known_value.contiguous(), valid.contiguous(), smoothing);
  return push(pull<torch::Tensor>({known_value, valid}), smoothing);
}

}  // namespace alight
