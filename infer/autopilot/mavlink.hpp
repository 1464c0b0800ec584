#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace alight {

/// What a MAVLink message says, before it is framed.
struct MavlinkMessage {
  std::uint32_t id = 0;        ///< 24 bits
  std::uint8_t crc_extra = 0;  ///< stands for the message's definition: field names, types and order
  std::vector<std::uint8_t> payload;
};

/// Writes a payload field by field, little endian. Fields go in wire order: those of the original message by falling
/// size, then the extension fields as the definition lists them.
class MavlinkFields {
 public:
  template <class Number>
  MavlinkFields& put(Number value) {
    static_assert(std::is_arithmetic_v<Number>);
    std::uint8_t bytes[sizeof(Number)];
    std::memcpy(bytes, &value, sizeof(Number));  // x86-64 and arm64 are little endian
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof(Number));
    return *this;
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

/// The frames of one MAVLink component, in MAVLink 2's wire format (mavlink.io, "Packet Serialization"), unsigned.
/// Numbers them, so that the receiver can count what was lost.
class MavlinkFramer {
 public:
  /// @param system_id of the vehicle, 1 .. 255  @param component_id of this program, 1 .. 255
  MavlinkFramer(std::uint8_t system_id, std::uint8_t component_id)
      : system_id_(system_id), component_id_(component_id) {}

  /// @throws std::invalid_argument if the payload has more than 255 bytes or the id more than 24 bits
  std::vector<std::uint8_t> frame(const MavlinkMessage& message);

 private:
  std::uint8_t system_id_;
  std::uint8_t component_id_;
  std::uint8_t sequence_ = 0;
};

/// CRC-16/MCRF4XX, which MAVLink calls X.25, of a frame's bytes without its magic and, after them, the message's crc_extra.
std::uint16_t mavlink_crc(const std::uint8_t* bytes, std::size_t count, std::uint8_t crc_extra);

}  // namespace alight
