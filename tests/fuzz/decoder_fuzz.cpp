// Any bytes as a message of one type: every decoder of the type gives a measurement, none, or a DecodeError.
#include <cstdint>
#include <cstdlib>

#include "sensors/messages/decoders.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  bool known = false;
  for (const alight::Decoder& decoder : alight::decoders()) {
    if (decoder.type != ALIGHT_FUZZ_TYPE) continue;
    known = true;
    try {
      decoder.decode({data, size, 0}, {});
    } catch (const alight::DecodeError&) {
    }
  }
  if (!known) std::abort();  // types.txt names a type that has no decoder
  return 0;
}
