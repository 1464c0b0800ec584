#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <onnx/onnx_pb.h>

namespace alight {

/// A tensor in the graph: its name, and its shape [1,channels,height,width].
struct OnnxValue {
  std::string name;
  std::int64_t channels = 0;
  std::int64_t height = 0;
  std::int64_t width = 0;
};

/// Builds an ONNX graph of fixed size, one function an operator. Opset 10: the newest whose every operator used here
/// OpenCV 4.6's DNN module reads (it takes Clip's bounds as attributes alone). @throws std::invalid_argument for shapes that do not fit
class OnnxGraph {
 public:
  explicit OnnxGraph(const std::string& name) { graph_.set_name(name); }

  OnnxValue input(const std::string& name, std::int64_t channels, std::int64_t height, std::int64_t width);
  /// Gives `value` its public name. One value has one.
  void output(const std::string& name, const OnnxValue& value);

  /// A named constant; the same name again is the same one. @param data as many floats as `shape` says
  std::string constant(const std::string& name, const std::vector<std::int64_t>& shape, const float* data);

  struct Convolution {
    std::string weight;  ///< a constant [out,in,kernel,kernel]
    std::string bias;    ///< a constant [out]; empty: none
    std::int64_t out_channels = 0;
    std::int64_t kernel = 1;
    std::int64_t stride = 1;
    std::int64_t padding = 0;
  };
  OnnxValue convolution(const OnnxValue& x, const Convolution& layer);
  /// Names of constants [1,channels,1,1].
  struct Affine {
    std::string scale;
    std::string shift;
  };
  OnnxValue group_normalization(const OnnxValue& x, std::int64_t groups, double epsilon,
                                const Affine& affine);
  OnnxValue relu(const OnnxValue& x) { return unary("Relu", x); }
  OnnxValue sigmoid(const OnnxValue& x) { return unary("Sigmoid", x); }
  OnnxValue tanh(const OnnxValue& x) { return unary("Tanh", x); }
  OnnxValue exp(const OnnxValue& x) { return unary("Exp", x); }
  /// 3x3, stride 2.
  OnnxValue max_pool(const OnnxValue& x);
  OnnxValue global_max(const OnnxValue& x);
  OnnxValue concatenate(const std::vector<OnnxValue>& values);
  /// To a multiple of the size, every pixel repeated.
  OnnxValue enlarge(const OnnxValue& x, std::int64_t height, std::int64_t width);
  /// Adds columns at the right and rows below: zeros, or copies of the last.
  OnnxValue pad(const OnnxValue& x, std::int64_t height, std::int64_t width, bool replicate);
  OnnxValue crop(const OnnxValue& x, std::int64_t height, std::int64_t width);
  OnnxValue channel(const OnnxValue& x, std::int64_t index);
  /// Element by element; `b` may be constants, one a channel.
  OnnxValue add(const OnnxValue& a, const OnnxValue& b) { return binary("Add", a, b); }
  OnnxValue subtract(const OnnxValue& a, const OnnxValue& b) { return binary("Sub", a, b); }
  OnnxValue multiply(const OnnxValue& a, const OnnxValue& b) { return binary("Mul", a, b); }
  OnnxValue multiply(const OnnxValue& x, double factor);
  OnnxValue clamp(const OnnxValue& x, double low, double high);

  /// The file's bytes. @param metadata what readers of the file find beside the graph
  std::string serialize(const std::map<std::string, std::string>& metadata) const;

 private:
  onnx::NodeProto& node(const char* type, const std::vector<std::string>& inputs, const std::string& output);
  std::string fresh_name(const std::string& type);
  OnnxValue unary(const char* type, const OnnxValue& x);
  OnnxValue binary(const char* type, const OnnxValue& a, const OnnxValue& b);
  OnnxValue slice(const OnnxValue& x, const std::vector<std::int64_t>& start,
                  const std::vector<std::int64_t>& end, const std::vector<std::int64_t>& axes);
  std::string scalar(double value);
  std::string integers(const std::vector<std::int64_t>& values);

  onnx::GraphProto graph_;
  std::map<std::string, int> names_;
  std::set<std::string> constants_;
};

}  // namespace alight
