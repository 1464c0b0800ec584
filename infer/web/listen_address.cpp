#include "infer/web/listen_address.hpp"

#include <algorithm>
#include <cctype>

#include <arpa/inet.h>

#include "foundation/errors.hpp"

namespace alight {
namespace {

constexpr int kMaxPort = 65535;

/// @returns -1 where it is not a port
int port_of(const std::string& text) {
  const bool digits = std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
  if (text.empty() || text.size() > 5 || !digits) return -1;
  const int port = std::stoi(text);
  return port <= kMaxPort ? port : -1;
}

}  // namespace

bool is_ip_address(const std::string& text) {
  in6_addr any{};
  return inet_pton(AF_INET, text.c_str(), &any) == 1 || inet_pton(AF_INET6, text.c_str(), &any) == 1;
}

bool ListenAddress::loopback() const {
  in_addr v4{};
  if (inet_pton(AF_INET, host.c_str(), &v4) == 1) return ntohl(v4.s_addr) >> 24U == 127;
  return host == "localhost" || host == "::1";
}

std::string ListenAddress::text() const {
  const bool v6 = host.find(':') != std::string::npos;
  return (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

ListenAddress parse_listen_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  ListenAddress address;
  bool fits = colon != std::string::npos;
  if (fits) {
    address.host = text.substr(0, colon);
    address.port = port_of(text.substr(colon + 1));
    const bool bracketed =
        address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']';
    if (bracketed) address.host = address.host.substr(1, address.host.size() - 2);
    if (address.host.empty()) address.host = "127.0.0.1";
    fits = address.port >= 0 && bracketed == (address.host.find(':') != std::string::npos);
  }
  if (!fits) {
    throw ConfigError(
        "web address \"" + text +
        "\": expected host:port, such as :8080 (this computer alone), 0.0.0.0:8080 or [::]:8080");
  }
  return address;
}

}  // namespace alight
