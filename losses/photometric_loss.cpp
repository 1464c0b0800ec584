#include "losses/photometric_loss.hpp"

#include "foundation/config_reader.hpp"
#include "losses/masked_mean.hpp"
#include "losses/ssim.hpp"
#include "losses/view_synthesis.hpp"

namespace alight {
namespace {

/// The errors against one source and where they count.
struct SourceError {
  torch::Tensor error;   // [B,1,H,W]
  torch::Tensor counts;  // [B,1,H,W] bool
};

SourceError source_error(const torch::Tensor& target, const torch::Tensor& depth_m,
                         const torch::Tensor& intrinsics_px, const PhotometricSource& source,
                         double ssim_weight) {
  const SynthesisedView view = synthesise_view(source.image, depth_m, intrinsics_px, source.T_source_target);
  return {photometric_error(view.image, target, ssim_weight),
          view.valid & source.present.view({-1, 1, 1, 1})};
}

/// A sample's mean over those of its sources that it sees.
torch::Tensor mean_over_sources(const std::vector<SourceError>& errors) {
  std::vector<torch::Tensor> means;
  std::vector<torch::Tensor> any;
  for (const SourceError& e : errors) {
    const SampleMeans source = sample_means(e.error, e.counts);
    means.push_back(source.mean);
    any.push_back(source.any);
  }
  return masked_mean(torch::stack(means, 1), torch::stack(any, 1));
}

torch::Tensor minimum_over_sources(const std::vector<SourceError>& errors) {
  constexpr double kWorseThanAny = 1e6;
  std::vector<torch::Tensor> candidates;
  std::vector<torch::Tensor> counts;
  for (const SourceError& e : errors) {
    candidates.push_back(torch::where(e.counts, e.error, torch::full_like(e.error, kWorseThanAny)));
    counts.push_back(e.counts);
  }
  return masked_mean(std::get<0>(torch::cat(candidates, 1).min(1, true)), torch::cat(counts, 1).any(1, true));
}

}  // namespace

void bind(Binder& b, PhotometricLossConfig& c) {
  b.field("ssim_weight", c.ssim_weight, "share of the SSIM term, the rest is the absolute difference",
          between(0, 1));
  b.choice("reduction", c.reduction,
           {{"mean", PhotometricReduction::kMean}, {"min", PhotometricReduction::kMin}}, "over the sources");
  b.field("use_previous", c.use_previous, "compare with the left image before");
  b.field("use_next", c.use_next, "compare with the left image after");
  b.field("use_right", c.use_right, "compare with the right image");
}

torch::Tensor photometric_error(const torch::Tensor& a, const torch::Tensor& b, double ssim_weight) {
  const torch::Tensor dissimilarity = (1 - ssim_map(a, b)) / 2;
  return (ssim_weight * dissimilarity + (1 - ssim_weight) * (a - b).abs()).mean(1, true);
}

torch::Tensor photometric_loss(const torch::Tensor& target, const torch::Tensor& depth_m,
                               const torch::Tensor& intrinsics_px,
                               const std::vector<PhotometricSource>& sources,
                               const PhotometricLossConfig& config) {
  std::vector<SourceError> errors;
  for (const PhotometricSource& source : sources) {
    // Warping is half the cost of a loss: a source that no sample has is not warped for nothing.
    if (!source.present.any().item<bool>()) continue;
    errors.push_back(source_error(target, depth_m, intrinsics_px, source, config.ssim_weight));
  }
  if (errors.empty()) return depth_m.sum() * 0;
  return config.reduction == PhotometricReduction::kMean ? mean_over_sources(errors)
                                                         : minimum_over_sources(errors);
}

}  // namespace alight
