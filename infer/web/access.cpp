#include "infer/web/access.hpp"

#include <array>
#include <cstdint>

#include <strings.h>
#include <sys/random.h>
#include <unistd.h>

#include "foundation/errors.hpp"

namespace alight {
namespace {

bool same_name(const std::string& a, const std::string& b) { return strcasecmp(a.c_str(), b.c_str()) == 0; }

/// Without port and brackets.
std::string host_part(const std::string& header) {
  if (!header.empty() && header.front() == '[') return header.substr(1, header.find(']') - 1);
  return header.substr(0, header.find(':'));
}

std::string this_computer() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

}  // namespace

std::string random_token() {
  std::array<std::uint8_t, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw DataError("the system gives no random numbers (getrandom); name a web token in the configuration");
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

bool equal_in_constant_time(const std::string& a, const std::string& b) {
  std::size_t difference = a.size() ^ b.size();
  for (std::size_t i = 0; i < a.size() && !b.empty(); ++i)
    difference |= static_cast<std::size_t>(static_cast<unsigned char>(a[i] ^ b[i % b.size()]));
  return difference == 0;
}

bool names_this_server(const std::string& host_header, const ListenAddress& address) {
  const std::string host = host_part(host_header);
  if (host.empty()) return false;
  if (is_ip_address(host) || same_name(host, "localhost") || same_name(host, address.host)) return true;
  const std::string own = this_computer();
  return !own.empty() && (same_name(host, own) || same_name(host, own + ".local"));
}

bool comes_from_own_page(const std::string& origin, const std::string& host_header) {
  return origin.empty() || same_name(origin, "http://" + host_header);
}

}  // namespace alight
