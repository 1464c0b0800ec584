#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace alight {

/// CRC-32C (Castagnoli, RFC 3720 appendix B.4) of all bytes.
std::uint32_t crc32c(std::string_view bytes);

/// One record of a TFRecord file, the framing of TensorBoard's event files: length (8 bytes), masked CRC of the
/// length (4), the payload, masked CRC of the payload (4); little endian. A masked CRC is the CRC rotated right by 15
/// bits plus 0xa282ead8, so that a payload that holds CRCs itself keeps a CRC that means something.
std::string tfrecord(std::string_view payload);

}  // namespace alight
