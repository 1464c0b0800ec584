#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace alight {

/// A protobuf message in the making (protobuf.dev, "Encoding"): fields are appended in the order of the calls, without
/// a schema. Enough for what event_file.cpp writes, which would not justify protobuf's compiler and library.
class WireMessage {
 public:
  /// int64, int32 and enum fields.
  WireMessage& integer(std::uint32_t field, std::int64_t value);
  WireMessage& real(std::uint32_t field, double value);
  /// A `float` field.
  WireMessage& real32(std::uint32_t field, float value);
  /// A repeated double field, packed.
  WireMessage& reals(std::uint32_t field, const std::vector<double>& values);
  /// string and bytes fields.
  WireMessage& text(std::uint32_t field, std::string_view value);
  WireMessage& message(std::uint32_t field, const WireMessage& value) { return text(field, value.bytes()); }

  const std::string& bytes() const { return bytes_; }

 private:
  enum WireType : std::uint32_t { kVarint = 0, kFixed64 = 1, kLengthDelimited = 2, kFixed32 = 5 };

  void tag(std::uint32_t field, WireType type) { varint((field << 3U) | type); }
  void varint(std::uint64_t value);
  void fixed(std::uint64_t value, int size_bytes);

  std::string bytes_;
};

}  // namespace alight
