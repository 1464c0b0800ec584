#include "train/run_events.hpp"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "geometry/depth_map.hpp"
#include "train/data/sample_cache.hpp"
#include "train/network_pass.hpp"

namespace alight {
namespace {

constexpr double kPanelWindow_s = 0.3;

/// [1,3,H,W] RGB in 0..1 -> BGR
cv::Mat picture(const torch::Tensor& image) {
  const torch::Tensor bytes = (image[0] * 255).round().to(torch::kUInt8).permute({1, 2, 0}).contiguous();
  cv::Mat bgr;
  cv::cvtColor(
      cv::Mat(static_cast<int>(bytes.size(0)), static_cast<int>(bytes.size(1)), CV_8UC3, bytes.data_ptr()),
      bgr, cv::COLOR_RGB2BGR);
  return bgr;
}

}  // namespace

RunEvents::RunEvents(const std::filesystem::path& run, std::optional<std::int64_t> continue_after_step)
    : file_(run, continue_after_step) {}

void RunEvents::describe(std::int64_t step, const std::string& config, const std::string& provenance) {
  // Four leading spaces make a code block in Markdown.
  std::string block = "    ";
  for (const char c : provenance + config) block += c == '\n' ? std::string("\n    ") : std::string(1, c);
  file_.text("config", step, block);
}

void RunEvents::scalars(std::int64_t step, const std::vector<std::pair<std::string, double>>& values) {
  for (const auto& [tag, value] : values) file_.scalar(tag, step, value);
}

void RunEvents::weights(std::int64_t step, const DepthCompletionNet& net) {
  for (const auto& item : net->named_parameters()) {
    const torch::Tensor values =
        item.value().detach().to(torch::kCPU, torch::kFloat32).flatten().contiguous();
    const float* begin = values.data_ptr<float>();
    file_.histogram("weights/" + item.key(), step, {begin, begin + values.numel()});
  }
}

void RunEvents::panel(std::int64_t step, DepthCompletionNet net, const DepthSample& sample) {
  const torch::NoGradGuard no_grad;
  const torch::Device device = net->parameters().front().device();
  const auto compacted = std::make_shared<const CompactSample>(compact(sample));
  const Batch batch = stack({compacted}, {{}}, compacted->height_px, compacted->width_px)
                          .to(device, torch::MemoryFormat::Contiguous);
  NetworkInput input{batch.left, batch.right,
                     keep_window(batch.sparse_m, batch.offset_s, 0, torch::full({}, kPanelWindow_s, device)),
                     torch::ones({1}, torch::TensorOptions(torch::kBool).device(device))};
  const bool was_training = net->is_training();
  net->eval();
  const cv::Mat fed = tensor_to_depth(input.sparse_m[0].cpu());
  const cv::Mat refined = tensor_to_depth(predict(net, batch, input)[0].cpu());
  input.sparse_m = torch::zeros_like(input.sparse_m);
  const cv::Mat alone = tensor_to_depth(predict(net, batch, input)[0].cpu());
  net->train(was_training);
  double min_m = 0;
  double max_m = 0;
  cv::minMaxLoc(refined, &min_m, &max_m);
  cv::Mat panel;
  cv::hconcat(std::vector<cv::Mat>{picture(batch.left.cpu()), colour_depth(fed, min_m, max_m),
                                   colour_depth(refined, min_m, max_m), colour_depth(alone, min_m, max_m)},
              panel);
  file_.image("held_out", step, panel);
}

}  // namespace alight
