#pragma once

#include <filesystem>
#include <optional>

namespace alight {

/// Path of the running program.
std::filesystem::path this_executable();

/// The folder of the files that come with the program, `configs/` and `models/weights/`: `share/alight` beside the
/// folder that the program was installed to, wherever that has been moved since, and of a build tree, where it links to
/// the sources. Empty where there is none.
/// @param executable path of the program, links resolved
std::optional<std::filesystem::path> shipped_folder(const std::filesystem::path& executable);

/// A file that comes with the running program, such as "models/weights/default.pt", whatever the user's folder holds.
/// Empty where there is none.
std::optional<std::filesystem::path> shipped_file(const std::filesystem::path& name);

/// The file that a default, an option or a configuration names. A relative name counts from the working directory; one
/// below `configs/` or `models/` that is not there is looked for among the shipped files, and taking it is logged.
/// @returns `named` where it is there, or could not be a shipped file: whoever opens it says that it is missing
/// @throws ConfigError naming both places if a name that could be a shipped file's is in neither
std::filesystem::path input_file(const std::filesystem::path& named);

}  // namespace alight
