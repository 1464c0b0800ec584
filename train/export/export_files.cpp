#include "train/export/export_files.hpp"

#include <string>
#include <utility>

#include "foundation/errors.hpp"
#include "foundation/output_folder.hpp"
#include "train/export/onnx_export.hpp"
#include "train/export/torchscript_export.hpp"

namespace alight {
namespace fs = std::filesystem;
namespace {

using Exporter = std::string (*)(DepthCompletionNet, ExportSize, ExportedPart);

Exporter exporter_for(const fs::path& output) {
  const std::string extension = output.extension().string();
  if (extension == ".onnx") return onnx_model;
  if (extension == ".torchscript" || extension == ".ts") return torchscript_model;
  throw ConfigError(output.string() +
                    ": the format is told by the name's end; use .onnx, .torchscript, .ts or .pt");
}

fs::path with_suffix(const fs::path& output, const std::string& suffix) {
  return output.parent_path() / (output.stem().string() + suffix + output.extension().string());
}

}  // namespace

std::vector<fs::path> export_files(const fs::path& output, DepthCompletionNet net, ExportSize size,
                                   std::optional<ExportedPart> part) {
  const Exporter exporter = exporter_for(output);
  const DepthCompletionNet prepared = network_to_export(std::move(net));
  std::vector<std::pair<fs::path, ExportedPart>> files;
  if (part) {
    files = {{output, *part}};
  } else {
    files = {{output, ExportedPart::kWhole},
             {with_suffix(output, ".image_encoder"), ExportedPart::kImageEncoder},
             {with_suffix(output, ".refinement"), ExportedPart::kRefinement}};
  }
  std::vector<fs::path> written;
  for (const auto& [path, file_part] : files) {
    write_file_atomically(path, exporter(prepared, size, file_part));
    written.push_back(path);
  }
  return written;
}

}  // namespace alight
