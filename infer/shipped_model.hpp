#pragma once

#include <filesystem>
#include <optional>

namespace alight {

/// The network that comes with the program: `models/shipped/default.pt` of the source tree that the executable was built
/// in, or `share/alight/models/default.pt` beside the folder that it was installed to. Empty where there is none.
/// @param executable path of the running program
std::optional<std::filesystem::path> find_shipped_model(const std::filesystem::path& executable);

/// Path of the running program.
std::filesystem::path this_executable();

}  // namespace alight
