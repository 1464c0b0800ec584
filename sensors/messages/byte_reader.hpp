#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "geometry/frames.hpp"

namespace alight {

/// A message whose bytes are not what its type promises. The log counts and skips it.
class DecodeError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One message as the recorder stored it.
struct RawMessage {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
  std::int64_t receive_ns = 0;  ///< when the recorder got it; the time of types without a stamp
};

/// std_msgs/Header without its sequence number; the stamp in nanoseconds.
struct MessageHeader {
  std::int64_t stamp_ns = 0;
  std::string_view frame_id;  ///< valid as long as the message
};

/// Reads ROS 1's serialization (little endian, lengths as uint32) in place. Every length is checked against
/// what is left before it is used: ROS's own reader allocates first, so that one flipped bit can ask for 4
/// GB.
class ByteReader {
 public:
  explicit ByteReader(const RawMessage& message) : at_(message.data), left_(message.size) {}

  /// A number of the wire. @throws DecodeError at the end of the message
  template <class Number>
  Number read() {
    static_assert(std::is_arithmetic_v<Number>);
    Number value;
    std::memcpy(&value, take(sizeof(Number)), sizeof(Number));
    return value;
  }

  /// `count` raw bytes, valid as long as the message.
  const std::uint8_t* take(std::size_t count) {
    if (count > left_) {
      throw DecodeError("ends " + std::to_string(count - left_) + " bytes early");
    }
    const std::uint8_t* bytes = at_;
    at_ += count;
    left_ -= count;
    return bytes;
  }

  std::string_view read_string() {
    const auto length = read<std::uint32_t>();
    return {reinterpret_cast<const char*>(take(length)), length};
  }

  /// std_msgs/Header.
  MessageHeader read_header() {
    read<std::uint32_t>();  // seq
    const auto seconds = read<std::uint32_t>();
    const auto nanoseconds = read<std::uint32_t>();
    if (nanoseconds >= kNanosecondsPerSecond)
      throw DecodeError("stamp with " + std::to_string(nanoseconds) + " ns");
    return {seconds * kNanosecondsPerSecond + nanoseconds, read_string()};
  }

  std::size_t left() const { return left_; }

  /// A message of the right type has nothing behind its last field.
  void expect_end() const {
    if (left_ != 0) throw DecodeError(std::to_string(left_) + " bytes too many");
  }

 private:
  const std::uint8_t* at_;
  std::size_t left_;
};

}  // namespace alight
