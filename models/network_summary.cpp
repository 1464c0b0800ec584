#include "models/network_summary.hpp"

#include <map>
#include <sstream>

#include <ATen/record_function.h>
#include <fmt/format.h>

namespace alight {
namespace {

struct Recording {
  std::map<const void*, std::string> names;  // weight -> name
  std::string part;
  std::vector<LayerCost> layers;
};
thread_local Recording* recording = nullptr;

/// Called after every operator; inputs of aten::convolution begin with input, weight.
void on_operator_end(const at::RecordFunction& function, at::ObserverContext*) {
  if (recording == nullptr || std::string(function.name()) != "aten::convolution") return;
  const auto inputs = function.inputs();
  const auto& outputs = function.outputs();
  if (inputs.size() < 2 || outputs.empty() || !inputs[1].isTensor() || !outputs[0].isTensor()) return;
  const torch::Tensor weight = inputs[1].toTensor();
  const torch::Tensor output = outputs[0].toTensor();
  std::ostringstream shape;
  shape << output.sizes();
  const auto products_per_output = static_cast<double>(weight.numel() / weight.size(0));
  recording->layers.push_back({recording->part, recording->names[weight.unsafeGetTensorImpl()], shape.str(),
                               weight.numel(),
                               2e-9 * products_per_output * static_cast<double>(output.numel())});
}

std::unique_ptr<at::ObserverContext> on_operator_start(const at::RecordFunction&) { return nullptr; }

void append_row(std::string& table, const std::string& name, const std::string& output,
                std::int64_t parameters, double gflop) {
  table += fmt::format("{:38} {:20} {:12} {:>9.3f}\n", name, output, parameters, gflop);
}

}  // namespace

std::vector<LayerCost> measure_layers(DepthCompletionNet net, std::int64_t height_px, std::int64_t width_px) {
  const torch::AutoGradMode by_aten(true);  // without gradients convolve() goes past aten::convolution
  const bool was_training = net->is_training();
  net->eval();
  Recording current;
  for (const auto& item : net->named_parameters()) {
    current.names[item.value().unsafeGetTensorImpl()] = item.key().substr(0, item.key().rfind('.'));
  }
  const auto handle = at::addThreadLocalCallback(
      at::RecordFunctionCallback(on_operator_start, on_operator_end).needsInputs(true).needsOutputs(true));
  recording = &current;
  current.part = "image_encoder";
  const auto image_pyramid =
      net->encode_image(SceneView{torch::zeros({1, 3, height_px, width_px}), {}, {}, {}});
  current.part = "depth_encoder";
  const auto depth_pyramid = net->encode_depth(torch::zeros({1, 1, height_px, width_px}));
  current.part = "decoder";
  net->decode(image_pyramid, depth_pyramid);
  recording = nullptr;
  at::removeCallback(handle);
  net->train(was_training);
  return current.layers;
}

std::string describe_network(DepthCompletionNet net, std::int64_t height_px, std::int64_t width_px) {
  const std::vector<LayerCost> layers = measure_layers(net, height_px, width_px);
  std::string table = fmt::format("{:38} {:20} {:>12} {:>9}\n", "layer", "output", "weights", "GFLOP");
  std::string sums;
  double gflop_total = 0;
  for (const char* part : {"image_encoder", "depth_encoder", "decoder"}) {
    std::int64_t parameters = 0;
    double gflop = 0;
    for (const LayerCost& layer : layers) {
      if (layer.part != part) continue;
      append_row(table, layer.name, layer.output, layer.parameters, layer.gflop);
      parameters += layer.parameters;
      gflop += layer.gflop;
    }
    append_row(sums, std::string("sum of ") + part, "", parameters, gflop);
    gflop_total += gflop;
  }
  std::int64_t parameters = 0;
  for (const torch::Tensor& parameter : net->parameters()) parameters += parameter.numel();
  append_row(sums, "network (norms and biases too)", "", parameters, gflop_total);
  return table + sums + "GFLOP: multiplications and additions of the convolutions, 1 image of " +
         std::to_string(width_px) + "x" + std::to_string(height_px) + " px\n";
}

}  // namespace alight
