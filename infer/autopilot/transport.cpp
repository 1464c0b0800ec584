#include "infer/autopilot/transport.hpp"

#include <charconv>

#include "infer/autopilot/serial_transport.hpp"
#include "infer/autopilot/udp_transport.hpp"

namespace alight {
namespace {

std::optional<int> whole_number(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

bool in_brackets(const std::string& host) {
  return host.size() > 2 && host.front() == '[' && host.back() == ']';
}

}  // namespace

std::optional<Connection> parse_connection(const std::string& text) {
  const std::size_t first = text.find(':');
  const std::size_t last = text.rfind(':');
  if (first == std::string::npos || last <= first + 1) return std::nullopt;
  const std::string kind = text.substr(0, first);
  std::string address = text.substr(first + 1, last - first - 1);
  const std::optional<int> number = whole_number(text.substr(last + 1));
  if (!number) return std::nullopt;
  if (kind == "serial" && SerialTransport::knows_baud(*number))
    return Connection{Connection::Kind::kSerial, address, *number};
  if (kind != "udp" || *number < 1 || *number > 65535) return std::nullopt;
  if (in_brackets(address)) address = address.substr(1, address.size() - 2);
  return Connection{Connection::Kind::kUdp, address, *number};
}

std::string describe(const Connection& connection) {
  const bool serial = connection.kind == Connection::Kind::kSerial;
  const bool ipv6 = !serial && connection.address.find(':') != std::string::npos;
  return (serial ? "serial:" : "udp:") + (ipv6 ? "[" + connection.address + "]" : connection.address) + ":" +
         std::to_string(connection.number);
}

std::unique_ptr<Transport> open_transport(const Connection& connection) {
  if (connection.kind == Connection::Kind::kSerial) return std::make_unique<SerialTransport>(connection);
  return std::make_unique<UdpTransport>(connection);
}

}  // namespace alight
