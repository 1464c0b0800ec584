#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "geometry/camera.hpp"
#include "infer/replay/network_config.hpp"
#include "infer/replay/result_writer.hpp"

namespace alight {

/// How fast the network runs on board.
struct NetworkBenchmark {
  /// Milliseconds of: "full pass" and "refinement" as the predictor makes them, with the arithmetic before the learned
  /// part; "learned full pass" and "learned refinement" without, what an exported file computes.
  StageStatistics stages;
  double gflop = 0;  ///< of a full pass
  double refinement_gflop = 0;
  double convolution_gflop_per_s =
      0;  ///< median speed of a 3x3 convolution in the same type: what could be reached
  double resident_memory_mb = 0;

  std::string table() const;
  std::string json() const;
};

/// Times `runs` passes over random images, alternately. @param dump folder that the learned part's inputs and result are
/// written to as raw float32 (image_input.f32, depth_input.f32, depth_m.f32), for others to compute the same
/// @throws as make_network_predictor
NetworkBenchmark benchmark_network(const std::filesystem::path& checkpoint,
                                   const PinholeIntrinsics& intrinsics, double baseline_m,
                                   const NetworkConfig& config, int runs,
                                   const std::optional<std::filesystem::path>& dump);

}  // namespace alight
