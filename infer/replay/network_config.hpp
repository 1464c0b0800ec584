#pragma once

#include <string>

#include "foundation/binder_fwd.hpp"

namespace alight {

/// In which numbers the network computes. `auto`: float16 on CUDA; bfloat16 on a processor with instructions for it
/// (AVX512_BF16); else float32.
enum class NetworkPrecision { kAuto, kFloat32, kBfloat16, kFloat16 };

/// Where and how the network runs.
struct NetworkConfig {
  std::string device = "auto";  ///< auto | cpu | cuda | cuda:N
  NetworkPrecision precision = NetworkPrecision::kAuto;
  int threads = 0;  ///< of the processor; 0: all
};
void bind(Binder& b, NetworkConfig& c);

}  // namespace alight
