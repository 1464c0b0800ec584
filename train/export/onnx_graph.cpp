#include "train/export/onnx_graph.hpp"

#include <functional>
#include <numeric>
#include <stdexcept>

namespace alight {
namespace {

constexpr std::int64_t kOpset = 10;

using Shape = std::vector<std::int64_t>;

void set_float_type(onnx::ValueInfoProto& info, const std::string& name, const OnnxValue& value) {
  info.set_name(name);
  onnx::TypeProto_Tensor& tensor = *info.mutable_type()->mutable_tensor_type();
  tensor.set_elem_type(onnx::TensorProto::FLOAT);
  for (const std::int64_t size : {std::int64_t{1}, value.channels, value.height, value.width}) {
    tensor.mutable_shape()->add_dim()->set_dim_value(size);
  }
}

void set(onnx::NodeProto& node, const char* name, std::int64_t value) {
  onnx::AttributeProto& attribute = *node.add_attribute();
  attribute.set_name(name);
  attribute.set_type(onnx::AttributeProto::INT);
  attribute.set_i(value);
}

void set(onnx::NodeProto& node, const char* name, const Shape& values) {
  onnx::AttributeProto& attribute = *node.add_attribute();
  attribute.set_name(name);
  attribute.set_type(onnx::AttributeProto::INTS);
  for (const std::int64_t value : values) attribute.add_ints(value);
}

void set(onnx::NodeProto& node, const char* name, const char* value) {
  onnx::AttributeProto& attribute = *node.add_attribute();
  attribute.set_name(name);
  attribute.set_type(onnx::AttributeProto::STRING);
  attribute.set_s(value);
}

void set_float(onnx::NodeProto& node, const char* name, double value) {
  onnx::AttributeProto& attribute = *node.add_attribute();
  attribute.set_name(name);
  attribute.set_type(onnx::AttributeProto::FLOAT);
  attribute.set_f(static_cast<float>(value));
}

}  // namespace

onnx::NodeProto& OnnxGraph::node(const char* type, const std::vector<std::string>& inputs,
                                 const std::string& output) {
  onnx::NodeProto& added = *graph_.add_node();
  added.set_op_type(type);
  added.set_name(output);
  for (const std::string& input : inputs) added.add_input(input);
  added.add_output(output);
  return added;
}

std::string OnnxGraph::fresh_name(const std::string& type) {
  return type + "_" + std::to_string(++names_[type]);
}

OnnxValue OnnxGraph::input(const std::string& name, std::int64_t channels, std::int64_t height,
                           std::int64_t width) {
  const OnnxValue value{name, channels, height, width};
  set_float_type(*graph_.add_input(), name, value);
  return value;
}

void OnnxGraph::output(const std::string& name, const OnnxValue& value) {
  node("Identity", {value.name}, name);
  set_float_type(*graph_.add_output(), name, value);
}

std::string OnnxGraph::constant(const std::string& name, const Shape& shape, const float* data) {
  if (!constants_.insert(name).second) return name;
  onnx::TensorProto& tensor = *graph_.add_initializer();
  tensor.set_name(name);
  tensor.set_data_type(onnx::TensorProto::FLOAT);
  for (const std::int64_t size : shape) tensor.add_dims(size);
  const auto count = static_cast<std::size_t>(
      std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies<>()));
  tensor.set_raw_data(data, count * sizeof(float));
  return name;
}

std::string OnnxGraph::integers(const Shape& values) {
  const std::string name = fresh_name("integers");
  onnx::TensorProto& tensor = *graph_.add_initializer();
  tensor.set_name(name);
  tensor.set_data_type(onnx::TensorProto::INT64);
  tensor.add_dims(static_cast<std::int64_t>(values.size()));
  for (const std::int64_t value : values) tensor.add_int64_data(value);
  return name;
}

std::string OnnxGraph::scalar(double value) {
  const auto number = static_cast<float>(value);
  return constant(fresh_name("number"), {}, &number);
}

OnnxValue OnnxGraph::convolution(const OnnxValue& x, const Convolution& layer) {
  const auto out = [&](std::int64_t size) {
    return (size + 2 * layer.padding - layer.kernel) / layer.stride + 1;
  };
  const OnnxValue y{fresh_name("Conv"), layer.out_channels, out(x.height), out(x.width)};
  std::vector<std::string> inputs{x.name, layer.weight};
  if (!layer.bias.empty()) inputs.push_back(layer.bias);
  onnx::NodeProto& conv = node("Conv", inputs, y.name);
  set(conv, "kernel_shape", Shape{layer.kernel, layer.kernel});
  set(conv, "strides", Shape{layer.stride, layer.stride});
  set(conv, "pads", Shape(4, layer.padding));
  return y;
}

OnnxValue OnnxGraph::group_normalization(const OnnxValue& x, std::int64_t groups, double epsilon,
                                         const Affine& affine) {
  const std::string grouped = fresh_name("Reshape");
  node("Reshape", {x.name, integers({1, groups, x.channels / groups * x.height, x.width})}, grouped);
  const std::vector<float> one(static_cast<std::size_t>(groups), 1.0F);
  const std::vector<float> zero(static_cast<std::size_t>(groups), 0.0F);
  const std::string normal = fresh_name("InstanceNormalization");
  set_float(node("InstanceNormalization",
                 {grouped, constant(normal + ".one", {groups}, one.data()),
                  constant(normal + ".zero", {groups}, zero.data())},
                 normal),
            "epsilon", epsilon);
  OnnxValue y = x;
  y.name = fresh_name("Reshape");
  node("Reshape", {normal, integers({1, x.channels, x.height, x.width})}, y.name);
  return add(multiply(y, {affine.scale, x.channels, 1, 1}), {affine.shift, x.channels, 1, 1});
}

OnnxValue OnnxGraph::max_pool(const OnnxValue& x) {
  const OnnxValue y{fresh_name("MaxPool"), x.channels, (x.height + 1) / 2, (x.width + 1) / 2};
  onnx::NodeProto& pool = node("MaxPool", {x.name}, y.name);
  set(pool, "kernel_shape", Shape{3, 3});
  set(pool, "strides", Shape{2, 2});
  set(pool, "pads", Shape{1, 1, 1, 1});
  return y;
}

OnnxValue OnnxGraph::global_max(const OnnxValue& x) {
  const OnnxValue y{fresh_name("GlobalMaxPool"), x.channels, 1, 1};
  node("GlobalMaxPool", {x.name}, y.name);
  return y;
}

OnnxValue OnnxGraph::concatenate(const std::vector<OnnxValue>& values) {
  OnnxValue y{fresh_name("Concat"), 0, values.front().height, values.front().width};
  std::vector<std::string> names;
  for (const OnnxValue& value : values) {
    if (value.height != y.height || value.width != y.width) {
      throw std::invalid_argument("OnnxGraph: concatenate needs maps of one size");
    }
    names.push_back(value.name);
    y.channels += value.channels;
  }
  set(node("Concat", names, y.name), "axis", 1);
  return y;
}

OnnxValue OnnxGraph::enlarge(const OnnxValue& x, std::int64_t height, std::int64_t width) {
  if (x.height == height && x.width == width) return x;
  if (height % x.height != 0 || width % x.width != 0) {
    throw std::invalid_argument("OnnxGraph: enlarge needs a multiple of the size");
  }
  const OnnxValue y{fresh_name("Resize"), x.channels, height, width};
  const float scales[4] = {1, 1, static_cast<float>(height / x.height), static_cast<float>(width / x.width)};
  set(node("Resize", {x.name, constant(y.name + ".scales", {4}, scales)}, y.name), "mode", "nearest");
  return y;
}

OnnxValue OnnxGraph::pad(const OnnxValue& x, std::int64_t height, std::int64_t width, bool replicate) {
  if (x.height == height && x.width == width) return x;
  const OnnxValue y{fresh_name("Pad"), x.channels, height, width};
  onnx::NodeProto& pad = node("Pad", {x.name}, y.name);
  set(pad, "pads", Shape{0, 0, 0, 0, 0, 0, height - x.height, width - x.width});
  set(pad, "mode", replicate ? "edge" : "constant");
  return y;
}

OnnxValue OnnxGraph::slice(const OnnxValue& x, const Shape& start, const Shape& end, const Shape& axes) {
  OnnxValue y = x;
  y.name = fresh_name("Slice");
  node("Slice", {x.name, integers(start), integers(end), integers(axes)}, y.name);
  return y;
}

OnnxValue OnnxGraph::crop(const OnnxValue& x, std::int64_t height, std::int64_t width) {
  if (x.height == height && x.width == width) return x;
  OnnxValue y = slice(x, {0, 0}, {height, width}, {2, 3});
  y.height = height;
  y.width = width;
  return y;
}

OnnxValue OnnxGraph::channel(const OnnxValue& x, std::int64_t index) {
  OnnxValue y = slice(x, {index}, {index + 1}, {1});
  y.channels = 1;
  return y;
}

OnnxValue OnnxGraph::unary(const char* type, const OnnxValue& x) {
  OnnxValue y = x;
  y.name = fresh_name(type);
  node(type, {x.name}, y.name);
  return y;
}

OnnxValue OnnxGraph::binary(const char* type, const OnnxValue& a, const OnnxValue& b) {
  const bool number_a_channel = b.height == 1 && b.width == 1;
  if (a.channels != b.channels || !(number_a_channel || (a.height == b.height && a.width == b.width))) {
    throw std::invalid_argument(std::string("OnnxGraph: ") + type + " of maps that do not fit");
  }
  OnnxValue y = a;
  y.name = fresh_name(type);
  node(type, {a.name, b.name}, y.name);
  return y;
}

OnnxValue OnnxGraph::multiply(const OnnxValue& x, double factor) {
  OnnxValue y = x;
  y.name = fresh_name("Mul");
  node("Mul", {x.name, scalar(factor)}, y.name);
  return y;
}

OnnxValue OnnxGraph::clamp(const OnnxValue& x, double low, double high) {
  OnnxValue y = x;
  y.name = fresh_name("Clip");
  onnx::NodeProto& clip = node("Clip", {x.name}, y.name);
  set_float(clip, "min", low);
  set_float(clip, "max", high);
  return y;
}

std::string OnnxGraph::serialize(const std::map<std::string, std::string>& metadata) const {
  onnx::ModelProto model;
  model.set_ir_version(onnx::IR_VERSION_2019_9_19);
  model.set_producer_name("alight");
  onnx::OperatorSetIdProto& opset = *model.add_opset_import();
  opset.set_domain("");
  opset.set_version(kOpset);
  *model.mutable_graph() = graph_;
  for (const auto& [key, value] : metadata) {
    onnx::StringStringEntryProto& entry = *model.add_metadata_props();
    entry.set_key(key);
    entry.set_value(value);
  }
  return model.SerializeAsString();
}

}  // namespace alight
