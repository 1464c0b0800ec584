#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "foundation/errors.hpp"

namespace alight {

/// Where an autopilot is: `udp:host:port` (an IPv6 address in brackets) or `serial:device:baud`.
struct Connection {
  enum class Kind { kUdp, kSerial };
  Kind kind = Kind::kUdp;
  std::string address;  ///< host name, IP address or device file
  int number = 0;       ///< port, or baud rate
};
/// Empty if `text` is neither, or the port or baud rate is none that exists.
std::optional<Connection> parse_connection(const std::string& text);
/// As parse_connection reads it.
std::string describe(const Connection& connection);

/// A way for bytes to an autopilot. What comes back is not read.
class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// All of `frame` or nothing that counts; waits no longer than a fifth of a second.
  /// @throws DataError with cause and cure. The transport is then of no use: open another.
  virtual void send(const std::vector<std::uint8_t>& frame) = 0;
};

/// Looks up the host or opens the device. A name that a slow or absent name server has to answer for takes as long as
/// the system lets it. @throws DataError with cause and cure
std::unique_ptr<Transport> open_transport(const Connection& connection);

}  // namespace alight
