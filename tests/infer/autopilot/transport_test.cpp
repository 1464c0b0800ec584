#include "infer/autopilot/transport.hpp"

#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "foundation/errors.hpp"
#include "tests/infer/autopilot/receivers.hpp"

namespace alight {
namespace {

using receivers::Bytes;
using ::testing::HasSubstr;

std::unique_ptr<Transport> open(const std::string& text) {
  return open_transport(parse_connection(text).value());
}

/// What goes wrong when this is done; empty: nothing.
template <class Action>
std::string failure_of(const Action& action) {
  try {
    action();
  } catch (const DataError& error) {
    return error.what();
  }
  return {};
}

Bytes every_byte() {
  Bytes bytes(256);
  std::iota(bytes.begin(), bytes.end(), std::uint8_t{0});
  return bytes;
}

TEST(Connection, ReadsWhatItDescribes) {
  for (const std::string text :
       {"udp:127.0.0.1:14550", "udp:autopilot.local:1", "udp:[::1]:65535", "serial:/dev/ttyTHS1:921600",
        "serial:/dev/serial/by-id/usb-ArduPilot_Pixhawk-if00:57600"}) {
    const auto connection = parse_connection(text);
    ASSERT_TRUE(connection) << text;
    EXPECT_EQ(describe(*connection), text);
  }
  const auto serial = parse_connection("serial:/dev/serial/by-path/pci-0000:00:14.0-usb:115200");
  ASSERT_TRUE(serial);
  EXPECT_EQ(serial->address, "/dev/serial/by-path/pci-0000:00:14.0-usb");
  EXPECT_EQ(parse_connection("udp:[::1]:14550")->address, "::1");
}

TEST(Connection, RefusesWhatIsNone) {
  for (const std::string text : {"", "udp", "udp:", "udp::14550", "udp:host", "udp:host:", "udp:host:0",
                                 "udp:host:65536", "udp:host:14550x", "tcp:host:5760", "serial:/dev/ttyTHS1",
                                 "serial:/dev/ttyTHS1:123", "serial::921600", "14550"}) {
    EXPECT_FALSE(parse_connection(text)) << text;
  }
}

TEST(UdpTransport, SendsAFrameAsOneDatagram) {
  const receivers::UdpPort port;
  const auto transport = open(port.connection());
  transport->send(every_byte());
  transport->send({1, 2, 3});
  EXPECT_EQ(port.receive(), every_byte());
  EXPECT_EQ(port.receive(), (Bytes{1, 2, 3}));
}

TEST(UdpTransport, SaysThatNothingListens) {
  const receivers::UdpPort port;
  port.refuse_all();
  const auto transport = open(port.connection());
  const std::string failure = failure_of([&] {
    for (int i = 0; i < 100; ++i) transport->send({1});  // the refusal of one comes back with a later one
  });
  EXPECT_THAT(failure, HasSubstr("nothing listens there"));
}

TEST(UdpTransport, SaysThatTheHostIsNotFound) {
  EXPECT_THAT(failure_of([] { open("udp:256.256.256.256:14550"); }), HasSubstr("the host is not found"));
}

TEST(SerialTransport, SendsEveryByteUnchanged) {
  const receivers::SerialPort port;
  const auto transport = open(port.connection());
  transport->send(every_byte());
  EXPECT_EQ(port.receive(256), every_byte());
}

TEST(SerialTransport, SaysThatTheDeviceIsMissing) {
  EXPECT_THAT(failure_of([] { open("serial:/dev/no_such_port:115200"); }), HasSubstr("plug the cable in"));
}

TEST(SerialTransport, SaysThatTheDeviceIsNoSerialPort) {
  EXPECT_THAT(failure_of([] { open("serial:/dev/null:115200"); }), HasSubstr("name a serial port"));
}

TEST(SerialTransport, SaysThatTheCableWasPulled) {
  receivers::SerialPort port;
  const auto transport = open(port.connection());
  transport->send({1});
  port.unplug();
  EXPECT_THAT(failure_of([&] { transport->send({2}); }), HasSubstr("plug the cable in again"));
}

TEST(SerialTransport, GivesUpOnAPortThatTakesNoMoreBytes) {
  const receivers::SerialPort port;
  const auto transport = open(port.connection());
  port.jam();
  const SteadyTime begin = steady_now();
  EXPECT_THAT(failure_of([&] { transport->send(every_byte()); }), HasSubstr("takes no more bytes"));
  EXPECT_LT(milliseconds(begin, steady_now()), receivers::kPatience_ms);
}

}  // namespace
}  // namespace alight
