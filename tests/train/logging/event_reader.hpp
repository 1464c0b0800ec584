#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace alight::test {

/// A decoded protobuf message: all values of every field number, without a schema. Written against the encoding's
/// description, not against WireMessage.
struct Fields {
  std::map<int, std::vector<std::uint64_t>> numbers;  ///< varint, fixed64 and fixed32, as bits
  std::map<int, std::vector<std::string>> texts;      ///< strings, bytes, messages, packed values

  std::uint64_t number(int field) const { return numbers.at(field).at(0); }
  const std::string& text(int field) const { return texts.at(field).at(0); }
  double real(int field) const {
    double value = 0;
    std::memcpy(&value, &numbers.at(field).at(0), sizeof value);
    return value;
  }
  float real32(int field) const {
    const auto bits = static_cast<std::uint32_t>(number(field));
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
};

inline std::uint64_t read_fixed(const std::string& bytes, std::size_t at, int size) {
  std::uint64_t value = 0;
  for (int i = size - 1; i >= 0; --i) {
    value = value << 8U | static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(i)));
  }
  return value;
}

inline std::uint64_t read_varint(const std::string& bytes, std::size_t& at) {
  std::uint64_t value = 0;
  for (unsigned shift = 0;; shift += 7) {
    const auto byte = static_cast<unsigned char>(bytes.at(at++));
    value |= static_cast<std::uint64_t>(byte & 0x7fU) << shift;
    if (byte < 0x80) return value;
  }
}

inline Fields decode(const std::string& bytes) {
  Fields fields;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::uint64_t tag = read_varint(bytes, at);
    const int field = static_cast<int>(tag >> 3U);
    const int size = (tag & 7U) == 1 ? 8 : 4;
    switch (tag & 7U) {
      case 0:
        fields.numbers[field].push_back(read_varint(bytes, at));
        break;
      case 2: {
        const std::uint64_t length = read_varint(bytes, at);
        if (at + length > bytes.size()) throw std::runtime_error("field ends outside of its message");
        fields.texts[field].push_back(bytes.substr(at, length));
        at += length;
        break;
      }
      case 1:
      case 5:
        fields.numbers[field].push_back(read_fixed(bytes, at, size));
        at += static_cast<std::size_t>(size);
        break;
      default:
        throw std::runtime_error("unknown wire type");
    }
  }
  return fields;
}

inline std::vector<double> unpack_reals(const std::string& bytes) {
  std::vector<double> values(bytes.size() / sizeof(double));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(double));
  return values;
}

/// The payloads of a TFRecord file's records, one decoded message each; CRCs are not looked at.
inline std::vector<Fields> decode_records(const std::string& file) {
  std::vector<Fields> messages;
  for (std::size_t at = 0; at < file.size();) {
    const std::uint64_t length = read_fixed(file, at, 8);
    messages.push_back(decode(file.substr(at + 12, length)));
    at += 16 + length;
    if (at > file.size()) throw std::runtime_error("last record is cut short");
  }
  return messages;
}

}  // namespace alight::test
