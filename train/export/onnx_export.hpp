#pragma once

#include <string>

#include "train/export/exported_part.hpp"

namespace alight {

/// The network as an ONNX model (opset 10) that ONNX Runtime and OpenCV's DNN module compute alike.
/// @param net of network_to_export()
/// @returns the file's bytes, with export_metadata() as metadata_props
std::string onnx_model(DepthCompletionNet net, ExportSize size, ExportedPart part);

}  // namespace alight
