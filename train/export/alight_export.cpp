#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "foundation/command_line.hpp"
#include "foundation/shipped_files.hpp"
#include "models/checkpoint.hpp"
#include "train/export/export_files.hpp"

namespace {

using namespace alight;

constexpr const char* kExamples =
    "Examples:\n"
    "  alight-export --checkpoint runs/demo/best.pt --output net.onnx\n"
    "  alight-export --checkpoint runs/demo/best.pt --output net.onnx --size 640 352 --graph whole\n"
    "  alight-export --checkpoint runs/demo/best.pt --output net.torchscript\n"
    "  alight-export --checkpoint runs/demo/best.pt --output models/mine.pt   (half precision, no training "
    "state)\n";

struct Options {
  std::string checkpoint;
  std::string output;
  std::vector<int> size_px{352};
  std::optional<ExportedPart> part;
};

void add_options(CLI::App& app, Options& options) {
  const std::map<std::string, std::optional<ExportedPart>> graphs{
      {"all", {}},
      {"whole", ExportedPart::kWhole},
      {"image_encoder", ExportedPart::kImageEncoder},
      {"refinement", ExportedPart::kRefinement}};
  std::vector<std::string> names;
  for (const auto& item : graphs) names.push_back(item.first);
  app.add_option("-c,--checkpoint", options.checkpoint, "Network of alight-train, such as runs/demo/best.pt")
      ->required();
  app.add_option(
         "-o,--output", options.output,
         "File to write: .onnx, TorchScript as .torchscript or .ts, or a checkpoint to pass on as .pt")
      ->required();
  app.add_option("--size", options.size_px, "Width and height of the images, or one number for both, pixels")
      ->expected(1, 2)
      ->capture_default_str()
      ->check(CLI::Range(1, 8192));
  app.add_option_function<std::string>(
         "--graph", [&options, graphs](const std::string& name) { options.part = graphs.at(name); },
         "The whole network, or a half of it in a file of its own; all: the three, the halves beside the "
         "whole")
      ->default_str("all")
      ->check(CLI::IsMember(names));
  app.footer(kExamples);
}

int run(const Options& options) {
  const LoadedNetwork network = load_network(input_file(options.checkpoint));
  if (std::filesystem::path(options.output).extension() == ".pt") {
    save_network(options.output, network.net, network.info);
    std::printf("wrote %s\n", options.output.c_str());
    return kExitOk;
  }
  const ExportSize size{options.size_px.back(), options.size_px.front()};
  for (const auto& path : export_files(options.output, network.net, size, options.part)) {
    std::printf("wrote %s (%lld x %lld px)\n", path.string().c_str(), static_cast<long long>(size.width_px),
                static_cast<long long>(size.height_px));
  }
  return kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("alight-export: writes a trained network for other programs, as ONNX or TorchScript");
  Options options;
  add_options(app, options);
  return run_tool(app, argc, argv, [&] { return run(options); });
}
