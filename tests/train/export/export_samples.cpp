#include <cstdio>
#include <filesystem>
#include <string>

#include "foundation/output_folder.hpp"
#include "tests/train/export/exported_net.hpp"
#include "train/export/export_files.hpp"

/// Writes what ONNX Runtime is compared with: `export_samples FOLDER` makes for every variant NAME.onnx and its halves,
/// and every input and output as raw float32 in NAME.<tensor>.f32.
namespace {

using namespace alight;

void write(const std::filesystem::path& path, const torch::Tensor& tensor) {
  const torch::Tensor values = tensor.contiguous();
  const auto bytes = static_cast<std::size_t>(values.numel()) * sizeof(float);
  write_file_atomically(path, std::string(reinterpret_cast<const char*>(values.data_ptr<float>()), bytes));
}

void write(const std::filesystem::path& folder, const test::ExportVariant& variant) {
  const std::string name = variant.name;
  DepthCompletionNet net = test::random_net(variant.config);
  const test::Reference r = test::reference(net, /*with_points=*/true);
  export_files(folder / (name + ".onnx"), net, test::kExportSize);
  write(folder / (name + ".image.f32"), r.image);
  write(folder / (name + ".depth.f32"), r.depth);
  write(folder / (name + ".depth_m.f32"), r.depth_m);
  for (int i = 0; i < kFeatureMaps; ++i) {
    write(folder / (name + "." + feature_name(i) + ".f32"), r.image_features[static_cast<std::size_t>(i)]);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: export_samples FOLDER\n", stderr);
    return 2;
  }
  std::filesystem::create_directories(argv[1]);
  for (const auto& variant : test::export_variants()) write(argv[1], variant);
  return 0;
}
