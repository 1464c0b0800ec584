#include "train/export/torchscript_export.hpp"

#include <sstream>
#include <vector>

#include <torch/csrc/jit/frontend/tracer.h>
#include <torch/script.h>

namespace alight {
namespace {

using torch::jit::Stack;
using Tensors = std::vector<torch::Tensor>;

/// The same tree of modules and parameters; tracing finds them by identity. A type's name has to be an identifier, which
/// the "0" of a torch::nn::Sequential is not.
torch::jit::Module script_tree(const torch::nn::Module& module, const std::string& type_name) {
  torch::jit::Module script(type_name);
  for (const auto& item : module.named_parameters(/*recurse=*/false)) {
    item.value().requires_grad_(false);
    script.register_parameter(item.key(), item.value(), /*is_buffer=*/false);
  }
  for (const auto& item : module.named_children()) {
    script.register_module(item.key(), script_tree(*item.value(), type_name + "._" + item.key()));
  }
  return script;
}

Tensors tensors(const Stack& stack) {
  Tensors values;
  for (const c10::IValue& value : stack) values.push_back(value.toTensor());
  return values;
}

/// An input of the right shape for every input of the part.
Stack example_inputs(DepthCompletionNet net, ExportSize size, ExportedPart part) {
  const DepthCompletionConfig& config = net->config();
  const torch::Tensor image = torch::rand({1, image_channels(config), size.height_px, size.width_px});
  const torch::Tensor depth =
      torch::rand({1, depth_channels(config.depth_input), size.height_px, size.width_px});
  if (part == ExportedPart::kImageEncoder) return {image};
  if (part == ExportedPart::kWhole) return {image, depth};
  Stack inputs;
  if (config.detail_width > 0) inputs.emplace_back(image);
  for (const torch::Tensor& map : net->image_features(image)) inputs.emplace_back(map);
  inputs.emplace_back(depth);
  return inputs;
}

torch::Tensor decode(DepthCompletionNet net, const torch::Tensor& image, const Tensors& image_maps,
                     const torch::Tensor& depth) {
  Tensors image_pyramid{image};
  image_pyramid.insert(image_pyramid.end(), image_maps.begin(), image_maps.end());
  Tensors depth_pyramid{depth};
  for (const torch::Tensor& map : net->depth_features(depth)) depth_pyramid.push_back(map);
  return net->decode(image_pyramid, depth_pyramid);
}

c10::IValue compute(DepthCompletionNet net, ExportedPart part, const Tensors& inputs) {
  if (part == ExportedPart::kWhole) return decode(net, inputs[0], net->image_features(inputs[0]), inputs[1]);
  if (part == ExportedPart::kRefinement) {
    const Tensors image_maps(inputs.end() - 1 - kFeatureMaps, inputs.end() - 1);
    // Without a detail layer decode() asks the image for nothing but its size.
    const torch::Tensor& image = net->config().detail_width > 0 ? inputs.front() : inputs.back();
    return decode(net, image, image_maps, inputs.back());
  }
  std::vector<c10::IValue> maps;
  for (const torch::Tensor& map : net->image_features(inputs[0])) maps.emplace_back(map);
  return c10::ivalue::Tuple::create(std::move(maps));
}

}  // namespace

std::string torchscript_model(DepthCompletionNet net, ExportSize size, ExportedPart part) {
  torch::NoGradGuard no_grad;
  torch::jit::Module script = script_tree(*net, "__torch__.DepthCompletionNet");
  const auto traced = torch::jit::tracer::trace(
      example_inputs(net, size, part),
      [&](const Stack& inputs) { return Stack{compute(net, part, tensors(inputs))}; },
      [](const torch::autograd::Variable&) { return std::string(); }, /*strict=*/true,
      /*force_outplace=*/false, &script);
  const auto function = script._ivalue()->compilation_unit()->create_function(
      c10::QualifiedName(*script.type()->name(), "forward"), traced.first->graph);
  script.type()->addMethod(function);
  script.eval();
  torch::jit::ExtraFilesMap extra_files;
  for (const auto& [key, value] : export_metadata(net->config())) extra_files[key] = value;
  std::ostringstream bytes;
  script.save(bytes, extra_files);
  return bytes.str();
}

}  // namespace alight
