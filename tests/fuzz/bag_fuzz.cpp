// Any bytes as a bag: it is read to its end, or refused with a DataError.
#include <cstdint>
#include <cstdlib>
#include <string>

#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <unistd.h>

#include "foundation/errors.hpp"
#include "tests/sensors/test_flight.hpp"

namespace {

/// A file in memory, with a path.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : fd_(memfd_create("bag", 0)) {
    if (fd_ < 0 || write(fd_, data, size) != static_cast<ssize_t>(size)) std::abort();
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  spdlog::set_level(spdlog::level::off);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const MemoryFile file(data, size);
  try {
    alight::FlightLog log(file.path(), alight::testing::small_rig(), {});
    alight::testing::read_all(log);
  } catch (const alight::DataError&) {
  }
  return 0;
}
