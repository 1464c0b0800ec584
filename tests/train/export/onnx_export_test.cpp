#include "train/export/onnx_export.hpp"

#include <onnx/onnx_pb.h>
#include <opencv2/dnn.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/train/export/exported_net.hpp"

namespace alight {
namespace {

using test::kExportSize;
using test::Reference;
using testing::HasSubstr;
using testing::Pair;

constexpr double kTolerance = 1e-4;

cv::Mat to_mat(const torch::Tensor& tensor) {
  std::vector<int> sizes;
  for (const std::int64_t size : tensor.sizes()) sizes.push_back(static_cast<int>(size));
  return cv::Mat(sizes, CV_32F, tensor.contiguous().data_ptr<float>()).clone();
}

torch::Tensor to_tensor(const cv::Mat& mat) {
  std::vector<std::int64_t> sizes(mat.size.p, mat.size.p + mat.dims);
  return torch::from_blob(mat.data, sizes, torch::kFloat32).clone();
}

/// A model as OpenCV's DNN module runs it.
class OpenCvModel {
 public:
  explicit OpenCvModel(const std::string& bytes)
      : net_(cv::dnn::readNetFromONNX(bytes.data(), bytes.size())) {}

  std::vector<torch::Tensor> run(const test::NamedTensors& inputs, const std::vector<cv::String>& outputs) {
    for (const auto& [name, tensor] : inputs) net_.setInput(to_mat(tensor), name);
    std::vector<cv::Mat> results;
    net_.forward(results, outputs);
    std::vector<torch::Tensor> tensors;
    for (const cv::Mat& result : results) tensors.push_back(to_tensor(result));
    return tensors;
  }

 private:
  cv::dnn::Net net_;
};

std::vector<cv::String> feature_names() {
  std::vector<cv::String> names;
  for (int i = 0; i < kFeatureMaps; ++i) names.push_back(feature_name(i));
  return names;
}

class OnnxExport : public testing::TestWithParam<test::ExportVariant> {
 protected:
  OnnxExport() : net_(test::random_net(GetParam().config)), exported_(network_to_export(net_)) {}

  OpenCvModel model(ExportedPart part) { return OpenCvModel(onnx_model(exported_, kExportSize, part)); }
  test::NamedTensors inputs(const Reference& r, ExportedPart part) const {
    return test::inputs_of(r, GetParam().config, part);
  }

  DepthCompletionNet net_;
  DepthCompletionNet exported_;
};

TEST_P(OnnxExport, WholeNetworkIsTheSameInOpenCv) {
  OpenCvModel whole = model(ExportedPart::kWhole);
  for (const bool with_points : {true, false, true}) {
    const Reference r = test::reference(net_, with_points);
    const torch::Tensor depth_m = whole.run(inputs(r, ExportedPart::kWhole), {"depth_m"}).front();
    ASSERT_EQ(depth_m.sizes(), r.depth_m.sizes());
    EXPECT_LT(((depth_m - r.depth_m).abs() / r.depth_m).max().item<double>(), kTolerance) << with_points;
  }
}

TEST_P(OnnxExport, HalvesInSequenceAreTheSameInOpenCv) {
  OpenCvModel image_encoder = model(ExportedPart::kImageEncoder);
  OpenCvModel refinement = model(ExportedPart::kRefinement);
  Reference r = test::reference(net_, true);
  const auto features = image_encoder.run(inputs(r, ExportedPart::kImageEncoder), feature_names());
  ASSERT_EQ(features.size(), r.image_features.size());
  for (std::size_t i = 0; i < features.size(); ++i) {
    ASSERT_EQ(features[i].sizes(), r.image_features[i].sizes());
    EXPECT_LT(test::relative_error(features[i], r.image_features[i]), kTolerance) << i;
  }
  r.image_features = features;
  const torch::Tensor depth_m = refinement.run(inputs(r, ExportedPart::kRefinement), {"depth_m"}).front();
  EXPECT_LT(((depth_m - r.depth_m).abs() / r.depth_m).max().item<double>(), kTolerance);
}

TEST_P(OnnxExport, CarriesItsMetadataAndItsShapes) {
  onnx::ModelProto file;
  ASSERT_TRUE(file.ParseFromString(onnx_model(exported_, kExportSize, ExportedPart::kWhole)));
  std::map<std::string, std::string> metadata;
  for (const auto& entry : file.metadata_props()) metadata[entry.key()] = entry.value();
  EXPECT_EQ(metadata, export_metadata(exported_->config()));
  const auto& shape = file.graph().input(0).type().tensor_type().shape();
  EXPECT_EQ(file.graph().input(0).name(), "image");
  EXPECT_EQ(shape.dim(1).dim_value(), image_channels(GetParam().config));
  EXPECT_EQ(shape.dim(2).dim_value(), kExportSize.height_px);
  EXPECT_EQ(shape.dim(3).dim_value(), kExportSize.width_px);
}

INSTANTIATE_TEST_SUITE_P(All, OnnxExport, testing::ValuesIn(test::export_variants()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(ExportMetadata, SaysWhatTheNetworkExpects) {
  const auto metadata = export_metadata(test::tiny_paper_config());
  EXPECT_THAT(metadata, testing::Contains(Pair("alight.depth_kind", "perspective")));
  EXPECT_THAT(metadata, testing::Contains(Pair("alight.model_config", HasSubstr("depth_input: raw"))));
  EXPECT_THAT(metadata, testing::Contains(Pair("alight.depth", HasSubstr("[1,1,H,W]"))));
  EXPECT_THAT(export_metadata(test::tiny_shipped_config()),
              testing::Contains(Pair("alight.image", HasSubstr("stereo cue"))));
}

}  // namespace
}  // namespace alight
