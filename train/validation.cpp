#include "train/validation.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "foundation/config_reader.hpp"
#include "models/depth_conversion.hpp"
#include "models/inputs/altitude_plane.hpp"
#include "models/inputs/sparse_fill.hpp"
#include "train/data/density_sampling.hpp"

namespace alight {
namespace {

/// One sample as a batch of one.
struct Scene {
  SceneView view;
  torch::Tensor sparse_m;       // [1,1,H,W]
  torch::Tensor offset_s;       // [1,1,H,W]
  torch::Tensor dense_m;        // [1,1,H,W], undefined if there is none
  torch::Tensor plane_m;        // [1,1,H,W], 0: the height is unknown
  torch::Tensor intrinsics_px;  // [1,4]
};

Scene scene(const DepthSample& sample, const DepthCompletionConfig& config) {
  const torch::Tensor intrinsics_px = sample.intrinsics.unsqueeze(0);
  const torch::Tensor plane_m =
      altitude_planes(torch::tensor({sample.height_m}, torch::kFloat64), sample.down_camera.unsqueeze(0),
                      intrinsics_px, sample.left.size(1), sample.left.size(2), config.max_depth_m);
  SceneView view{sample.left.unsqueeze(0), sample.right.unsqueeze(0),
                 to_network_depth(plane_m, intrinsics_px, config.depth_kind),
                 intrinsics_px.select(1, 0) * sample.baseline_m};
  return {view,
          sample.sparse.unsqueeze(0),
          sample.offset_s.unsqueeze(0),
          sample.dense.defined() ? sample.dense.unsqueeze(0) : torch::Tensor(),
          plane_m,
          intrinsics_px};
}

void add(ValidationRow& row, const Scene& scene, const torch::Tensor& prediction_m,
         const torch::Tensor& fed_m) {
  const torch::Tensor known = scene.sparse_m > 0;
  row.ground_truth.add(prediction_m, scene.sparse_m, known);
  row.held_out.add(prediction_m, scene.sparse_m, known & (fed_m <= 0));
  if (scene.dense_m.defined()) row.dense.add(prediction_m, scene.dense_m, scene.dense_m > 0);
}

/// What the points say without a network, interpolated as the gated network's own input is.
torch::Tensor interpolated_m(const torch::Tensor& fed_m) {
  const torch::Tensor valid = (fed_m > 0).to(fed_m.dtype());
  return fill_pyramid(fed_m.clamp_min(1e-3).log(), valid).value.exp();
}

const ValidationRow& nearest_row(const std::vector<ValidationRow>& rows, double share) {
  const auto further = [share](const ValidationRow& a, const ValidationRow& b) {
    return std::isnan(b.share) || std::abs(a.share - share) < std::abs(b.share - share);
  };
  return *std::min_element(rows.begin(), rows.end(), further);
}

void add_network(ValidationReport& report, DepthCompletionNet net, const Scene& scene,
                 torch::Generator& generator) {
  const DepthKind kind = net->config().depth_kind;
  const auto image_pyramid = net->encode_image(scene.view);
  for (std::size_t i = 0; i < report.network.size(); ++i) {
    ValidationRow& row = report.network[i];
    const torch::Tensor fed_m =
        std::isnan(row.share) ? keep_window(scene.sparse_m, scene.offset_s, 0, torch::full({}, row.window_s))
                              : keep_share(scene.sparse_m, torch::tensor(row.share), generator);
    const auto depth_pyramid =
        net->encode_depth(to_network_depth(fed_m, scene.intrinsics_px, kind), scene.view.prior_m);
    const torch::Tensor depth = net->decode(image_pyramid, depth_pyramid);
    add(row, scene, from_network_depth(depth, scene.intrinsics_px, kind), fed_m);
    if ((fed_m > 0).any().item<bool>()) add(report.fill[i], scene, interpolated_m(fed_m), fed_m);
  }
}

void add_altitude_plane(ValidationReport& report, const Scene& scene) {
  if ((scene.plane_m > 0).any().item<bool>()) {
    add(report.altitude_plane, scene, scene.plane_m, torch::zeros_like(scene.sparse_m));
  }
}

ValidationReport empty_report(const ValidationConfig& config) {
  ValidationReport report;
  const auto add_rows = [&](const std::string& name, double share, double window_s) {
    report.network.push_back({name, share, window_s, {}, {}, {}});
    report.fill.push_back({"fill " + name, share, window_s, {}, {}, {}});
  };
  for (const double share : config.shares) add_rows(fmt::format("P={:g}", share), share, 0);
  for (const double window_s : config.windows_s)
    add_rows(fmt::format("{:g}s", window_s), std::nan(""), window_s);
  report.altitude_plane.name = "altitude plane";
  return report;
}

std::string cell(const ErrorMeter& meter) {
  if (meter.pixels() == 0) return "         -";
  return fmt::format("{:>10.1f}", meter.rmse_mm());
}

}  // namespace

void bind(Binder& b, ValidationConfig& c) {
  b.field("shares", c.shares, "shares of the points fed (P)", between(0, 1));
  b.field("windows_s", c.windows_s, "accumulation windows after the image, beside the shares",
          between(0.001, 60));
  b.field("samples", c.samples, "samples after every epoch, evenly spread; 0: all", at_least(0));
  b.field("final_samples", c.final_samples, "samples at the end of the run; 0: all", at_least(0));
  b.check("shares", !c.shares.empty(), "expected at least one share");
}

double ValidationReport::score_mm() const {
  double sum = 0;
  for (const ValidationRow& row : network) sum += std::log(std::max(row.ground_truth.rmse_mm(), 1e-3));
  return std::exp(sum / static_cast<double>(network.size()));
}

const ValidationRow& ValidationReport::at(double share) const { return nearest_row(network, share); }
const ValidationRow& ValidationReport::fill_at(double share) const { return nearest_row(fill, share); }

std::string ValidationReport::table() const {
  std::string text = "RMSE [mm]       LiDAR pixels  not fed of them  dense truth\n";
  const auto row_text = [&](const ValidationRow& row) {
    text += fmt::format("{:18}{}     {}   {}\n", row.name, cell(row.ground_truth), cell(row.held_out),
                        cell(row.dense));
  };
  for (const ValidationRow& row : network) row_text(row);
  for (const ValidationRow& row : fill) {
    if (row.ground_truth.pixels() > 0) row_text(row);
  }
  row_text(altitude_plane);
  return text;
}

std::string ValidationReport::summary() const {
  std::string text;
  for (const ValidationRow& row : network)
    text += fmt::format(" {} {:.0f}", row.name, row.ground_truth.rmse_mm());
  return text + fmt::format(", altitude plane {:.0f}", altitude_plane.ground_truth.rmse_mm());
}

std::vector<std::size_t> spread(std::size_t size, int count) {
  const std::size_t wanted = count <= 0 ? size : std::min(size, static_cast<std::size_t>(count));
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < wanted; ++i) chosen.push_back(i * size / wanted);
  return chosen;
}

ValidationReport validate(DepthCompletionNet net, SampleSource& source,
                          const std::vector<std::size_t>& samples, const ValidationConfig& config,
                          std::uint64_t seed, const std::function<void()>& progress) {
  torch::NoGradGuard no_grad;
  const bool was_training = net->is_training();
  net->eval();
  ValidationReport report = empty_report(config);
  for (const std::size_t index : samples) {
    const DepthSample sample = source.get(index);
    const Scene view = scene(sample, net->config());
    torch::Generator generator = at::detail::createCPUGenerator(seed + index);
    add_network(report, net, view, generator);
    add_altitude_plane(report, view);
    if (progress) progress();
  }
  report.samples = samples.size();
  net->train(was_training);
  return report;
}

}  // namespace alight
