#include "models/device.hpp"

#include "foundation/errors.hpp"

namespace alight {

torch::Device find_device(const std::string& name, int process) {
  const bool cuda = torch::cuda::is_available();
  if (name == "auto") return cuda ? find_device("cuda", process) : torch::Device(torch::kCPU);
  if (name == "cpu") return torch::kCPU;
  if (name.rfind("cuda", 0) != 0) {
    throw ConfigError("device: \"" + name + "\" is no device; expected auto, cpu, cuda or cuda:N");
  }
  if (!cuda)
    throw ConfigError("device: " + name + ", but this LibTorch finds no CUDA device; use cpu or auto");
  if (name == "cuda" && process > 0) {
    if (process < static_cast<int>(torch::cuda::device_count()))
      return {torch::kCUDA, static_cast<torch::DeviceIndex>(process)};
    throw ConfigError("device: process " + std::to_string(process) +
                      " of this machine finds no CUDA device of its own; start as many processes as devices");
  }
  try {
    return torch::Device(name);
  } catch (const c10::Error&) {
    throw ConfigError("device: \"" + name + "\" is no device; expected cuda or cuda:N");
  }
}

}  // namespace alight
