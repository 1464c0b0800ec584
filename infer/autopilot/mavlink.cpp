#include "infer/autopilot/mavlink.hpp"

#include <stdexcept>

namespace alight {
namespace {

constexpr std::uint8_t kMagic = 0xFD;
constexpr std::uint16_t kReversedPolynomial = 0x8408;  // x^16 + x^12 + x^5 + 1

/// Zeros at the payload's end are left out, but its first byte is always sent.
std::size_t truncated_size(const std::vector<std::uint8_t>& payload) {
  std::size_t size = payload.size();
  while (size > 1 && payload[size - 1] == 0) --size;
  return size;
}

}  // namespace

std::uint16_t mavlink_crc(const std::uint8_t* bytes, std::size_t count, std::uint16_t crc) {
  unsigned register_bits = crc;
  for (std::size_t i = 0; i < count; ++i) {
    register_bits ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit)
      register_bits = (register_bits >> 1) ^ ((register_bits & 1U) != 0 ? kReversedPolynomial : 0U);
  }
  return static_cast<std::uint16_t>(register_bits);
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
  const std::uint16_t crc =
      mavlink_crc(fields.bytes().data() + 1, fields.bytes().size() - 1);  // without magic
  return fields.put(mavlink_crc(&message.crc_extra, 1, crc)).bytes();
}

}  // namespace alight
