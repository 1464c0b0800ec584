#include "infer/autopilot/udp_transport.hpp"

#include <cerrno>
#include <memory>
#include <system_error>

#include <netdb.h>
#include <sys/socket.h>

#include "foundation/errors.hpp"

namespace alight {
namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Addresses look_up(const Connection& connection) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error =
      getaddrinfo(connection.address.c_str(), std::to_string(connection.number).c_str(), &hints, &found);
  if (error != 0) {
    throw DataError(describe(connection) + ": the host is not found: " + gai_strerror(error) +
                    "; write its IP address, or check the network");
  }
  return {found, &freeaddrinfo};
}

}  // namespace

UdpTransport::UdpTransport(const Connection& connection) : name_(describe(connection)) {
  const Addresses addresses = look_up(connection);
  int error = 0;
  for (const addrinfo* a = addresses.get(); a != nullptr; a = a->ai_next) {
    FileDescriptor candidate(
        ::socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, a->ai_protocol));
    // Connected, so that the system tells us when nothing listens there.
    if (candidate.open() && ::connect(candidate.get(), a->ai_addr, a->ai_addrlen) == 0) {
      socket_ = std::move(candidate);
      return;
    }
    error = errno;
  }
  throw DataError(name_ + ": no way to the host: " + std::generic_category().message(error) +
                  "; check the network's cable and address");
}

void UdpTransport::send(const std::vector<std::uint8_t>& frame) {
  if (::send(socket_.get(), frame.data(), frame.size(), 0) >= 0) return;
  const int error = errno;
  throw DataError(name_ + ": " + std::generic_category().message(error) +
                  (error == ECONNREFUSED
                       ? "; nothing listens there: start the autopilot or its router, check the port"
                       : "; check the network's cable and address"));
}

}  // namespace alight
