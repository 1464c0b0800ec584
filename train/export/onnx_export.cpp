#include "train/export/onnx_export.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "train/export/onnx_graph.hpp"

namespace alight {
namespace {

constexpr double kGroupNormEpsilon = 1e-5;  // torch::group_norm's
constexpr std::size_t kDecoderLevels = 5;

std::int64_t round_up(std::int64_t size, std::int64_t multiple) {
  return (size + multiple - 1) / multiple * multiple;
}

/// Writes down, operator by operator, what DepthCompletionNet computes; parts have its names and its order.
class NetworkGraph {
 public:
  NetworkGraph(DepthCompletionNet net, ExportSize size)
      : net_(net),
        config_(net->config()),
        size_(size),
        modules_(net->named_modules()),
        parameters_(net->named_parameters()) {}

  std::string build(ExportedPart part) {
    switch (part) {
      case ExportedPart::kImageEncoder:
        add_image_encoder();
        break;
      case ExportedPart::kRefinement:
        add_refinement();
        break;
      case ExportedPart::kWhole:
        add_whole();
        break;
    }
    return graph_.serialize(export_metadata(config_));
  }

 private:
  OnnxValue image() {
    return graph_.input("image", image_channels(config_), size_.height_px, size_.width_px);
  }
  OnnxValue depth() {
    return graph_.input("depth", depth_channels(config_.depth_input), size_.height_px, size_.width_px);
  }

  void add_whole() {
    const OnnxValue image_input = image();
    const OnnxValue depth_input = depth();
    graph_.output("depth_m", decode(image_input, image_features(image_input), depth_input));
  }

  void add_image_encoder() {
    const std::vector<OnnxValue> maps = image_features(image());
    for (int i = 0; i < kFeatureMaps; ++i) graph_.output(feature_name(i), maps[static_cast<std::size_t>(i)]);
  }

  void add_refinement() {
    const OnnxValue image_input = config_.detail_width > 0 ? image() : OnnxValue{};
    NetworkGraph encoder(net_, size_);  // built only to learn the maps' shapes
    std::vector<OnnxValue> maps = encoder.image_features(encoder.image());
    for (int i = 0; i < kFeatureMaps; ++i) {
      OnnxValue& map = maps[static_cast<std::size_t>(i)];
      map = graph_.input(feature_name(i), map.channels, map.height, map.width);
    }
    graph_.output("depth_m", decode(image_input, maps, depth()));
  }

  std::string parameter(const std::string& name, const std::vector<std::int64_t>& shape) {
    const torch::Tensor values = parameters_[name].detach().cpu().to(torch::kFloat32).contiguous();
    return graph_.constant(name, shape, values.data_ptr<float>());
  }

  OnnxValue convolution(const OnnxValue& x, const std::string& name) {
    const auto* conv = modules_[name]->as<torch::nn::Conv2d>();
    const std::int64_t kernel = conv->weight.size(2);
    return graph_.convolution(
        x, {parameter(name + ".weight", conv->weight.sizes().vec()),
            conv->bias.defined() ? parameter(name + ".bias", conv->bias.sizes().vec()) : std::string(),
            conv->weight.size(0), kernel, conv->options.stride()->at(0), kernel / 2});
  }

  /// conv_block()
  OnnxValue block(const OnnxValue& x, const std::string& name) {
    OnnxValue y = convolution(x, name + ".conv");
    if (modules_.contains(name + ".norm")) {
      const std::vector<std::int64_t> shape{1, y.channels, 1, 1};
      y = graph_.group_normalization(
          y, group_count(y.channels), kGroupNormEpsilon,
          {parameter(name + ".norm.weight", shape), parameter(name + ".norm.bias", shape)});
    }
    return modules_.contains(name + ".relu") ? graph_.relu(y) : y;
  }

  /// BasicBlock
  OnnxValue basic_block(const OnnxValue& x, const std::string& name) {
    const OnnxValue residual = block(block(x, name + ".first"), name + ".second");
    const std::string shortcut = name + ".shortcut";
    return graph_.relu(graph_.add(residual, modules_.contains(shortcut) ? block(x, shortcut) : x));
  }

  /// ResnetEncoder, and the padding before it
  std::vector<OnnxValue> encode(const OnnxValue& input, const std::string& name, bool replicate) {
    const std::int64_t stride = encoder_stride(config_.stem);
    const OnnxValue x =
        graph_.pad(input, round_up(input.height, stride), round_up(input.width, stride), replicate);
    std::vector<OnnxValue> maps{block(x, name + ".stem")};
    OnnxValue map = config_.stem == Stem::kDownsample ? graph_.max_pool(maps.front()) : maps.front();
    for (int stage = 1; stage < kFeatureMaps; ++stage) {
      const std::string prefix = name + ".stage" + std::to_string(stage);
      map = basic_block(basic_block(map, prefix + ".0"), prefix + ".1");
      maps.push_back(map);
    }
    return maps;
  }

  std::vector<OnnxValue> image_features(const OnnxValue& input) {
    return encode(input, "image_encoder", true);
  }

  /// DepthCompletionNet::decode(), and the depth encoder before it
  OnnxValue decode(const OnnxValue& image_input, const std::vector<OnnxValue>& image_maps,
                   const OnnxValue& depth_input) {
    const std::vector<OnnxValue> depth_maps = encode(depth_input, "depth_encoder", false);
    const auto fused = [&](std::size_t level) {
      return config_.fusion == Fusion::kSum ? graph_.add(image_maps[level], depth_maps[level])
                                            : graph_.concatenate({image_maps[level], depth_maps[level]});
    };
    OnnxValue x = fused(kDecoderLevels - 1);
    for (std::size_t i = 0; i + 1 < kDecoderLevels; ++i) {
      const OnnxValue skip = fused(kDecoderLevels - 2 - i);
      x = block(graph_.concatenate({graph_.enlarge(x, skip.height, skip.width), skip}),
                "decoder" + std::to_string(i + 1));
    }
    const std::int64_t full = config_.stem == Stem::kDownsample ? 2 : 1;
    x = graph_.enlarge(x, x.height * full, x.width * full);
    x = graph_.crop(block(x, "decoder5"), depth_input.height, depth_input.width);
    if (config_.detail_width > 0) x = block(graph_.concatenate({x, image_input, depth_input}), "detail");
    return to_depth(convolution(x, "head"), depth_input);
  }

  /// DepthCompletionNet::to_depth()
  OnnxValue to_depth(const OnnxValue& raw, const OnnxValue& depth_input) {
    OnnxGraph& g = graph_;
    if (config_.head == Head::kDirect) {
      const double range = std::log(config_.max_depth_m / config_.min_depth_m);
      return g.multiply(g.exp(g.multiply(g.sigmoid(raw), range)), config_.min_depth_m);
    }
    // Enlarged because OpenCV's DNN module does not multiply a map by a computed number.
    const OnnxValue any =
        g.enlarge(g.global_max(g.channel(depth_input, filled_input::kValid)), raw.height, raw.width);
    const OnnxValue gate = g.multiply(g.sigmoid(g.channel(raw, 1)), any);
    const OnnxValue from_prior = g.multiply(g.tanh(g.channel(raw, 0)), kLargestPriorCorrection);
    const OnnxValue from_fill = g.add(g.channel(depth_input, filled_input::kFill),
                                      g.multiply(g.tanh(g.channel(raw, 2)), kLargestFillCorrection));
    const OnnxValue relative = g.add(from_prior, g.multiply(gate, g.subtract(from_fill, from_prior)));
    const OnnxValue ratio = g.exp(g.add(g.channel(depth_input, filled_input::kPrior), relative));
    return g.clamp(g.multiply(ratio, config_.depth_scale_m), config_.min_depth_m, config_.max_depth_m);
  }

  DepthCompletionNet net_;
  DepthCompletionConfig config_;
  ExportSize size_;
  torch::OrderedDict<std::string, std::shared_ptr<torch::nn::Module>> modules_;
  torch::OrderedDict<std::string, torch::Tensor> parameters_;
  OnnxGraph graph_{"DepthCompletionNet"};
};

}  // namespace

std::string onnx_model(DepthCompletionNet net, ExportSize size, ExportedPart part) {
  return NetworkGraph(std::move(net), size).build(part);
}

}  // namespace alight
