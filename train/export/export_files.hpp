#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "train/export/exported_part.hpp"

namespace alight {

/// Writes one part of the network to `output`: ONNX for `.onnx`, TorchScript for `.torchscript` and `.ts`.
/// Without `part` all three: `net.onnx`, `net.image_encoder.onnx` and `net.refinement.onnx` for `net.onnx`.
/// @returns the files written
/// @throws ConfigError for another extension, DataError if a file cannot be written
std::vector<std::filesystem::path> export_files(const std::filesystem::path& output, DepthCompletionNet net,
                                                ExportSize size, std::optional<ExportedPart> part = {});

}  // namespace alight
