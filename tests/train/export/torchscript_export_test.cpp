#include "train/export/torchscript_export.hpp"

#include <sstream>

#include <torch/script.h>

#include <gtest/gtest.h>

#include "tests/train/export/exported_net.hpp"

namespace alight {
namespace {

using test::kExportSize;
using test::Reference;

class TorchscriptExport : public testing::TestWithParam<test::ExportVariant> {
 protected:
  TorchscriptExport() : net_(test::random_net(GetParam().config)), exported_(network_to_export(net_)) {}

  torch::jit::Module model(ExportedPart part, torch::jit::ExtraFilesMap& extra_files) {
    std::istringstream bytes(torchscript_model(exported_, kExportSize, part));
    return torch::jit::load(bytes, torch::kCPU, extra_files);
  }
  c10::IValue run(ExportedPart part, const Reference& r) {
    torch::jit::ExtraFilesMap none;
    std::vector<c10::IValue> inputs;
    for (const auto& [name, tensor] : test::inputs_of(r, GetParam().config, part))
      inputs.emplace_back(tensor);
    torch::NoGradGuard no_grad;
    return model(part, none).forward(inputs);
  }

  DepthCompletionNet net_;
  DepthCompletionNet exported_;
};

TEST_P(TorchscriptExport, ReloadedItPredictsTheSame) {
  for (const bool with_points : {true, false}) {
    const Reference r = test::reference(net_, with_points);
    for (const ExportedPart part : {ExportedPart::kWhole, ExportedPart::kRefinement}) {
      const torch::Tensor depth_m = run(part, r).toTensor();
      ASSERT_EQ(depth_m.sizes(), r.depth_m.sizes());
      EXPECT_LT(((depth_m - r.depth_m).abs() / r.depth_m).max().item<double>(), 1e-4);
    }
  }
}

TEST_P(TorchscriptExport, ReloadedImageEncoderGivesTheSameMaps) {
  const Reference r = test::reference(net_, true);
  const auto maps = run(ExportedPart::kImageEncoder, r).toTupleRef().elements().vec();
  ASSERT_EQ(maps.size(), r.image_features.size());
  for (std::size_t i = 0; i < maps.size(); ++i) {
    EXPECT_LT(test::relative_error(maps[i].toTensor(), r.image_features[i]), 1e-4) << i;
  }
}

TEST_P(TorchscriptExport, KeepsParameterNamesAndMetadata) {
  torch::jit::ExtraFilesMap extra_files;
  for (const auto& item : export_metadata(exported_->config())) extra_files[item.first];
  const torch::jit::Module reloaded = model(ExportedPart::kWhole, extra_files);
  std::set<std::string> names;
  for (const auto& item : reloaded.named_parameters()) names.insert(item.name);
  for (const auto& item : exported_->named_parameters()) EXPECT_EQ(names.count(item.key()), 1) << item.key();
  for (const auto& [key, value] : export_metadata(exported_->config())) EXPECT_EQ(extra_files[key], value);
}

INSTANTIATE_TEST_SUITE_P(All, TorchscriptExport, testing::ValuesIn(test::export_variants()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace alight
