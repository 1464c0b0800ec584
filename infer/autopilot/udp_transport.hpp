#pragma once

#include <string>

#include "infer/autopilot/file_descriptor.hpp"
#include "infer/autopilot/transport.hpp"

namespace alight {

/// One datagram a frame, IPv4 or IPv6.
class UdpTransport : public Transport {
 public:
  /// @throws DataError if the host is unknown or no network leads to it
  explicit UdpTransport(const Connection& connection);
  void send(const std::vector<std::uint8_t>& frame) override;

 private:
  std::string name_;
  FileDescriptor socket_;
};

}  // namespace alight
