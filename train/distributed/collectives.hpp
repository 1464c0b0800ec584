#pragma once

#include <chrono>
#include <memory>

#include <torch/torch.h>

#include "foundation/errors.hpp"
#include "train/distributed/process_place.hpp"

namespace alight {

/// What processes do together: all call the same, in the same order, with tensors of one size and type. Throws
/// std::exception of any kind when another process is gone or does not answer in time.
class Collectives {
 public:
  virtual ~Collectives() = default;
  /// Where tensors have to lie.
  virtual torch::Device device() const = 0;
  /// The sum over all processes, everywhere bit for bit the same. @param flat [N], in place
  virtual void sum(torch::Tensor& flat) = 0;
  /// What rank 0 has. @param flat [N], in place
  virtual void broadcast(torch::Tensor& flat) = 0;
};

/// Meets the other processes by torch::distributed (c10d): NCCL for CUDA where this LibTorch has it, else Gloo.
/// @param cuda whether training computes there @param timeout for every answer
/// @throws ConfigError if this build has neither, std::exception if somebody does not come
std::unique_ptr<Collectives> connect(const ProcessPlace& place, bool cuda, std::chrono::seconds timeout);

}  // namespace alight
