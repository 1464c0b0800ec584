#pragma once

#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <google/protobuf/unknown_field_set.h>

namespace alight::test {

/// A decoded protobuf message: all values of every field number, without event_file.proto, whose numbers are under test.
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

inline Fields decode(const std::string& bytes) {
  using google::protobuf::UnknownField;
  google::protobuf::UnknownFieldSet message;
  if (!message.ParseFromString(bytes)) throw std::runtime_error("no protobuf message");
  Fields fields;
  for (int i = 0; i < message.field_count(); ++i) {
    const UnknownField& field = message.field(i);
    switch (field.type()) {
      case UnknownField::TYPE_VARINT:
        fields.numbers[field.number()].push_back(field.varint());
        break;
      case UnknownField::TYPE_FIXED32:
        fields.numbers[field.number()].push_back(field.fixed32());
        break;
      case UnknownField::TYPE_FIXED64:
        fields.numbers[field.number()].push_back(field.fixed64());
        break;
      case UnknownField::TYPE_LENGTH_DELIMITED:
        fields.texts[field.number()].push_back(field.length_delimited());
        break;
      default:
        throw std::runtime_error("a group, which TensorBoard has none of");
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
