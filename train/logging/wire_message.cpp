#include "train/logging/wire_message.hpp"

#include <cstring>

namespace alight {
namespace {

std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

std::uint32_t bits_of(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

void WireMessage::varint(std::uint64_t value) {
  for (; value >= 0x80; value >>= 7U) bytes_ += static_cast<char>((value & 0x7fU) | 0x80U);
  bytes_ += static_cast<char>(value);
}

void WireMessage::fixed(std::uint64_t value, int size_bytes) {
  for (int i = 0; i < size_bytes; ++i, value >>= 8U) bytes_ += static_cast<char>(value & 0xffU);
}

WireMessage& WireMessage::integer(std::uint32_t field, std::int64_t value) {
  tag(field, kVarint);
  varint(static_cast<std::uint64_t>(value));
  return *this;
}

WireMessage& WireMessage::real(std::uint32_t field, double value) {
  tag(field, kFixed64);
  fixed(bits_of(value), 8);
  return *this;
}

WireMessage& WireMessage::real32(std::uint32_t field, float value) {
  tag(field, kFixed32);
  fixed(bits_of(value), 4);
  return *this;
}

WireMessage& WireMessage::reals(std::uint32_t field, const std::vector<double>& values) {
  tag(field, kLengthDelimited);
  varint(8 * values.size());
  for (const double value : values) fixed(bits_of(value), 8);
  return *this;
}

WireMessage& WireMessage::text(std::uint32_t field, std::string_view value) {
  tag(field, kLengthDelimited);
  varint(value.size());
  bytes_ += value;
  return *this;
}

}  // namespace alight
