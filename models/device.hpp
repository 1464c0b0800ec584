#pragma once

#include <string>

#include <torch/torch.h>

#include "foundation/errors.hpp"

namespace alight {

/// The device that `name` (auto | cpu | cuda | cuda:N) means on this machine; `auto` takes CUDA where there is one. Where
/// several processes share a machine, each takes the CUDA device of its number. @param process its number, from 0
/// @throws ConfigError for another name, or CUDA that is not there
torch::Device find_device(const std::string& name, int process = 0);

}  // namespace alight
