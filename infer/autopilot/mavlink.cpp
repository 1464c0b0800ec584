#include "infer/autopilot/mavlink.hpp"

#include <stdexcept>

#include <boost/crc.hpp>

namespace alight {
namespace {

constexpr std::uint8_t kMagic = 0xFD;

/// Zeros at the payload's end are left out, but its first byte is always sent.
std::size_t truncated_size(const std::vector<std::uint8_t>& payload) {
  std::size_t size = payload.size();
  while (size > 1 && payload[size - 1] == 0) --size;
  return size;
}

}  // namespace

std::uint16_t mavlink_crc(const std::uint8_t* bytes, std::size_t count, std::uint8_t crc_extra) {
  boost::crc_optimal<16, 0x1021, 0xFFFF, 0, true, true> crc;
  crc.process_bytes(bytes, count);
  crc.process_byte(crc_extra);
  return crc.checksum();
}

std::vector<std::uint8_t> MavlinkFramer::frame(const MavlinkMessage& message) {
  if (message.payload.size() > 255) throw std::invalid_argument("MAVLink: payload of more than 255 bytes");
  if (message.id > 0xFFFFFF) throw std::invalid_argument("MAVLink: message id of more than 24 bits");
  const std::size_t size = truncated_size(message.payload);
  MavlinkFields fields;
  fields.put(kMagic)
      .put(static_cast<std::uint8_t>(size))
      .put(std::uint8_t{0})  // nothing that a receiver has to understand
      .put(std::uint8_t{0})  // nothing that it may ignore
      .put(sequence_++)
      .put(system_id_)
      .put(component_id_)
      .put(static_cast<std::uint16_t>(message.id & 0xFFFF))
      .put(static_cast<std::uint8_t>(message.id >> 16));
  for (std::size_t i = 0; i < size; ++i) fields.put(message.payload[i]);
  const std::vector<std::uint8_t>& bytes = fields.bytes();  // the CRC leaves out the magic
  return fields.put(mavlink_crc(bytes.data() + 1, bytes.size() - 1, message.crc_extra)).bytes();
}

}  // namespace alight
