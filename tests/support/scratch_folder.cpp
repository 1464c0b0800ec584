#include "tests/support/scratch_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <string>
#include <system_error>

#include <unistd.h>

namespace alight::test {
namespace fs = std::filesystem;

ScratchFolder::ScratchFolder() : owner_(getpid()) {
  std::string name = (fs::temp_directory_path() / "alight_test_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::system_error(errno, std::generic_category(), name);
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  if (getpid() != owner_) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace alight::test
