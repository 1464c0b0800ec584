#pragma once

#include <string>

#include "foundation/errors.hpp"

namespace alight {

/// Where a server listens.
struct ListenAddress {
  std::string host;  ///< a name or an address, IPv6 without brackets
  int port = 0;      ///< 0: the system picks one

  /// Reachable from this computer alone.
  bool loopback() const;
  /// As in a URL: "127.0.0.1:8080", "[::1]:8080".
  std::string text() const;
};

/// "127.0.0.1:8080", "[::1]:8080", "drone.local:8080"; ":8080" is the loopback, 127.0.0.1.
/// @throws ConfigError
ListenAddress parse_listen_address(const std::string& text);

/// Whether a text is an IPv4 or IPv6 address (without brackets), not a name.
bool is_ip_address(const std::string& text);

}  // namespace alight
