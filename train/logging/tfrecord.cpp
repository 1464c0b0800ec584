#include "train/logging/tfrecord.hpp"

#include <cstddef>

#include <boost/crc.hpp>

namespace alight {
namespace {

std::uint32_t masked_crc32c(std::string_view bytes) {
  const std::uint32_t crc = crc32c(bytes);
  return ((crc >> 15U) | (crc << 17U)) + 0xa282ead8U;
}

std::string little_endian(std::uint64_t value, std::size_t bytes) {
  std::string out;
  for (std::size_t i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xffU);
  return out;
}

}  // namespace

std::uint32_t crc32c(std::string_view bytes) {
  boost::crc_optimal<32, 0x1EDC6F41, 0xFFFFFFFF, 0xFFFFFFFF, true, true> crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::string tfrecord(std::string_view payload) {
  std::string record = little_endian(payload.size(), 8);
  record += little_endian(masked_crc32c(record), 4);
  record += payload;
  record += little_endian(masked_crc32c(payload), 4);
  return record;
}

}  // namespace alight
