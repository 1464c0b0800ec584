#pragma once

#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "infer/autopilot/file_descriptor.hpp"
#include "infer/autopilot/mavlink.hpp"
#include "infer/onboard/steady_time.hpp"

/// The autopilot's end of a connection.
namespace alight::receivers {

using Bytes = std::vector<std::uint8_t>;

constexpr int kPatience_ms = 30'000;  ///< for what has to come, however busy the computer is

/// What is there, or comes within the patience; empty: nothing.
inline Bytes read_some(int fd) {
  pollfd readable{fd, POLLIN, 0};
  if (::poll(&readable, 1, kPatience_ms) != 1) return {};
  Bytes bytes(4096);
  const ssize_t count = ::read(fd, bytes.data(), bytes.size());
  bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
  return bytes;
}

/// A UDP port of this computer.
class UdpPort {
 public:
  UdpPort() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::bind(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    socklen_t size = sizeof address;
    EXPECT_EQ(::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
  }
  int fd() const { return socket_.get(); }
  int port() const { return port_; }
  std::string connection() const { return "udp:127.0.0.1:" + std::to_string(port_); }
  /// Takes datagrams of nobody any more; the port stays reserved.
  void refuse_all() const {
    sockaddr_in itself{};
    socklen_t size = sizeof itself;
    auto* generic = reinterpret_cast<sockaddr*>(&itself);
    EXPECT_EQ(::getsockname(socket_.get(), generic, &size), 0);
    EXPECT_EQ(::connect(socket_.get(), generic, size), 0);
  }
  /// One frame; empty: none came.
  Bytes receive() const { return read_some(fd()); }

 private:
  FileDescriptor socket_;
  int port_ = 0;
};

/// A serial port made of a pseudo terminal: `device()` is what the link opens.
class SerialPort {
 public:
  SerialPort() : autopilot_(::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    EXPECT_TRUE(autopilot_.open());
    EXPECT_EQ(::grantpt(autopilot_.get()), 0);
    EXPECT_EQ(::unlockpt(autopilot_.get()), 0);
    char name[128] = {};
    EXPECT_EQ(::ptsname_r(autopilot_.get(), name, sizeof name), 0);
    device_ = name;
    computer_ = FileDescriptor(::open(name, O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  }
  int fd() const { return autopilot_.get(); }
  const std::string& device() const { return device_; }
  std::string connection() const { return "serial:" + device_ + ":115200"; }
  Bytes receive(std::size_t count) const {
    Bytes all;
    while (all.size() < count) {
      const Bytes more = read_some(fd());
      if (more.empty()) break;
      all.insert(all.end(), more.begin(), more.end());
    }
    return all;
  }
  void unplug() { autopilot_ = FileDescriptor(), computer_ = FileDescriptor(); }
  /// As if the autopilot no longer took bytes.
  void jam() const { EXPECT_EQ(::tcflow(computer_.get(), TCOOFF), 0); }

 private:
  FileDescriptor autopilot_;
  FileDescriptor computer_;  // keeps the terminal alive while the link has it closed
  std::string device_;
};

/// A frame taken apart; the checksum is verified.
struct Frame {
  int sequence = 0;
  int system_id = 0;
  int component_id = 0;
  int id = 0;
  Bytes payload;
};
inline Frame take_apart(const Bytes& bytes) {
  Frame frame;
  if (bytes.size() < 13 || bytes[0] != 0xFD || bytes.size() != 12U + bytes[1]) {
    ADD_FAILURE() << "no MAVLink 2 frame of " << bytes.size() << " bytes";
    return frame;
  }
  frame.sequence = bytes[4];
  frame.system_id = bytes[5];
  frame.component_id = bytes[6];
  frame.id = bytes[7] + (bytes[8] << 8) + (bytes[9] << 16);
  frame.payload.assign(bytes.begin() + 10, bytes.end() - 2);
  const std::uint8_t crc_extra = frame.id == 149 ? 200 : 50;
  const std::uint16_t crc = mavlink_crc(bytes.data() + 1, bytes.size() - 3, crc_extra);
  EXPECT_EQ(bytes[bytes.size() - 2] + (bytes[bytes.size() - 1] << 8), crc);
  return frame;
}

}  // namespace alight::receivers
