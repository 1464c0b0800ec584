#pragma once

#include <string>

#include "train/export/exported_part.hpp"

namespace alight {

/// The network as a TorchScript module for torch::jit::load, in C++ or Python: `forward` takes the part's inputs in the
/// order of ExportedPart's description and gives a tensor, or a tuple for the image encoder. Parameters keep their
/// names, so that the module can be moved to another device.
/// @param net of network_to_export()
/// @returns the file's bytes, with export_metadata() as extra files
std::string torchscript_model(DepthCompletionNet net, ExportSize size, ExportedPart part);

}  // namespace alight
