#include "train/distributed/collectives.hpp"

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "foundation/errors.hpp"

// LibTorch's target defines USE_C10D_GLOO and USE_C10D_NCCL as it was built; what its headers include is not always
// installed with it. CMake says whether Gloo's are.
#if defined(USE_C10D_GLOO) && defined(ALIGHT_GLOO_HEADERS)
#define ALIGHT_GLOO
#endif
#if defined(USE_C10D_NCCL) && __has_include(<nccl.h>)
#define ALIGHT_NCCL
#endif

#if defined(ALIGHT_GLOO) || defined(ALIGHT_NCCL)
#include <torch/csrc/distributed/c10d/PrefixStore.hpp>
#include <torch/csrc/distributed/c10d/TCPStore.hpp>
#include <torch/version.h>
#endif
#ifdef ALIGHT_GLOO
#include <torch/csrc/distributed/c10d/ProcessGroupGloo.hpp>
#endif
#ifdef ALIGHT_NCCL
#include <torch/csrc/distributed/c10d/ProcessGroupNCCL.hpp>
#endif

namespace alight {

#if defined(ALIGHT_GLOO) || defined(ALIGHT_NCCL)
namespace {

#if TORCH_VERSION_MAJOR >= 2
using Backend = c10d::Backend;
#else
using Backend = c10d::ProcessGroup;
#endif

/// Processes start apart: the first waits for the last at least this long.
constexpr std::chrono::seconds kMeetingTimeout{60};

class C10dCollectives : public Collectives {
 public:
  C10dCollectives(c10::intrusive_ptr<Backend> backend, torch::Device device)
      : backend_(std::move(backend)), device_(device) {}
  torch::Device device() const override { return device_; }
  void sum(torch::Tensor& flat) override {
    std::vector<torch::Tensor> tensors{flat};
    backend_->allreduce(tensors)->wait();
  }
  void broadcast(torch::Tensor& flat) override {
    std::vector<torch::Tensor> tensors{flat};
    backend_->broadcast(tensors)->wait();
  }

 private:
  c10::intrusive_ptr<Backend> backend_;
  torch::Device device_;
};

c10::intrusive_ptr<c10d::Store> meet(const ProcessPlace& place, std::chrono::seconds timeout) {
  c10d::TCPStoreOptions options;
#if TORCH_VERSION_MAJOR > 2 || (TORCH_VERSION_MAJOR == 2 && TORCH_VERSION_MINOR >= 4)
  options.useLibUV = false;  // the default since 2.4, which Debian's build does not have
#endif
  options.port = static_cast<std::uint16_t>(place.master_port);
  options.isServer = place.rank == 0 && !place.served;
  if (!place.served) options.numWorkers = static_cast<std::size_t>(place.size);
  options.waitWorkers = !place.served;
  options.timeout = std::max(timeout, kMeetingTimeout);
  return c10::make_intrusive<c10d::PrefixStore>(
      "alight" + place.meeting_id, c10::make_intrusive<c10d::TCPStore>(place.master_address, options));
}

#ifdef ALIGHT_GLOO
std::shared_ptr<gloo::transport::Device> gloo_device(const ProcessPlace& place) {
  if (const char* interface = std::getenv("GLOO_SOCKET_IFNAME"); interface != nullptr && *interface != '\0')
    return c10d::ProcessGroupGloo::createDeviceForInterface(interface);
  // A container's own name often resolves to nothing, or to an address that nothing reaches.
  if (place.on_loopback()) return c10d::ProcessGroupGloo::createDeviceForHostname("127.0.0.1");
  return c10d::ProcessGroupGloo::createDefaultDevice();
}

c10::intrusive_ptr<Backend> gloo_backend(const ProcessPlace& place, std::chrono::seconds timeout) {
  const auto options = c10d::ProcessGroupGloo::Options::create(timeout);
  options->devices.push_back(gloo_device(place));
  return c10::make_intrusive<c10d::ProcessGroupGloo>(meet(place, timeout), place.rank, place.size, options);
}
#endif

#ifdef ALIGHT_NCCL
c10::intrusive_ptr<Backend> nccl_backend(const ProcessPlace& place, std::chrono::seconds timeout) {
  // Without it a wait returns before the others have answered and never says that they did not.
  setenv(TORCH_VERSION_MAJOR >= 2 ? "TORCH_NCCL_BLOCKING_WAIT" : "NCCL_BLOCKING_WAIT", "1", 0);
  const auto options = c10d::ProcessGroupNCCL::Options::create();
  options->timeout = timeout;
  return c10::make_intrusive<c10d::ProcessGroupNCCL>(meet(place, timeout), place.rank, place.size, options);
}
#endif

}  // namespace
#endif

std::unique_ptr<Collectives> connect(const ProcessPlace& place, [[maybe_unused]] bool cuda,
                                     [[maybe_unused]] std::chrono::seconds timeout) {
#ifdef ALIGHT_NCCL
  if (cuda) {
    const torch::Device device(torch::kCUDA, static_cast<torch::DeviceIndex>(place.local_rank));
    return std::make_unique<C10dCollectives>(nccl_backend(place, timeout), device);
  }
#endif
#ifdef ALIGHT_GLOO
  return std::make_unique<C10dCollectives>(gloo_backend(place, timeout), torch::kCPU);
#else
  throw ConfigError("environment variable WORLD_SIZE: " + std::to_string(place.size) +
                    ", but this build trains with one process; build it with a LibTorch that has "
                    "torch::distributed and with Gloo's headers (Debian: libgloo-dev)");
#endif
}

}  // namespace alight
