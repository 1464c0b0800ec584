#pragma once

#include <filesystem>

#include "foundation/errors.hpp"

namespace alight {

/// `alight-dataset inspect`: what a bag holds, to stdout. @returns the exit code. @throws DataError
int run_inspect(const std::filesystem::path& bag);

}  // namespace alight
