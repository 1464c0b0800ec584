#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sensors/messages/decoders.hpp"
#include "tests/sensors/test_flight.hpp"

/// Messages of ROS's own types through the decoders.
namespace alight::testing {

template <class Message>
std::vector<std::uint8_t> bytes_of(const Message& message) {
  std::vector<std::uint8_t> bytes(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::serialize(stream, message);
  return bytes;
}

inline std::optional<DecodedMessage> decode(LogRole role, const std::string& type,
                                            const std::vector<std::uint8_t>& bytes,
                                            std::int64_t receive_ns = kStart_ns,
                                            const DecodeOptions& options = {}) {
  return find_decoder(role, type)->decode({bytes.data(), bytes.size(), receive_ns}, options);
}

template <class Out, class Message>
Out decoded(LogRole role, const Message& message, const DecodeOptions& options = {},
            std::int64_t receive_ns = kStart_ns) {
  const auto result =
      decode(role, ros::message_traits::DataType<Message>::value(), bytes_of(message), receive_ns, options);
  return std::get<Out>(result.value());
}

/// Why a message is refused; empty: it is not.
template <class Message>
std::string error(LogRole role, const Message& message, const DecodeOptions& options = {}) {
  return message_of<DecodeError>([&] {
    decode(role, ros::message_traits::DataType<Message>::value(), bytes_of(message), kStart_ns, options);
  });
}

}  // namespace alight::testing
