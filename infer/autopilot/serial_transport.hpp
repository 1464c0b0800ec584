#pragma once

#include <string>

#include "foundation/errors.hpp"
#include "infer/autopilot/file_descriptor.hpp"
#include "infer/autopilot/transport.hpp"

namespace alight {

/// A serial port, 8N1 without flow control.
class SerialTransport : public Transport {
 public:
  /// @throws DataError if the device cannot be opened or does not take the baud rate
  explicit SerialTransport(const Connection& connection);
  void send(const std::vector<std::uint8_t>& frame) override;

  /// A rate that the system knows by number: 9600 .. 4000000.
  static bool knows_baud(int baud);

 private:
  void configure(int baud);

  std::string name_;
  FileDescriptor device_;
};

}  // namespace alight
