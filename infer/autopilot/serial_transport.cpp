#include "infer/autopilot/serial_transport.hpp"

#include <cerrno>
#include <chrono>
#include <map>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <termios.h>

#include "foundation/errors.hpp"
#include "infer/onboard/steady_time.hpp"

namespace alight {
namespace {

constexpr double kPatience_ms = 200;

const std::map<int, speed_t>& speeds() {
  static const std::map<int, speed_t> known = {
      {9600, B9600},       {19200, B19200},     {38400, B38400},     {57600, B57600},     {115200, B115200},
      {230400, B230400},   {460800, B460800},   {500000, B500000},   {576000, B576000},   {921600, B921600},
      {1000000, B1000000}, {1152000, B1152000}, {1500000, B1500000}, {2000000, B2000000}, {2500000, B2500000},
      {3000000, B3000000}, {3500000, B3500000}, {4000000, B4000000}};
  return known;
}

std::string opening_cure(int error) {
  if (error == ENOENT || error == ENXIO || error == ENODEV)
    return "plug the cable in, or name the right device";
  if (error == EACCES) return "add this user to the group that owns the device (Debian: dialout)";
  return "see that no other program uses it";
}

}  // namespace

bool SerialTransport::knows_baud(int baud) { return speeds().count(baud) > 0; }

SerialTransport::SerialTransport(const Connection& connection)
    : name_(describe(connection)),
      device_(::open(connection.address.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  if (!device_.open()) {
    const int error = errno;
    throw DataError(name_ + ": cannot be opened: " + std::generic_category().message(error) + "; " +
                    opening_cure(error));
  }
  configure(connection.number);
}

void SerialTransport::configure(int baud) {
  termios settings{};
  bool done = tcgetattr(device_.get(), &settings) == 0;
  if (done) {
    cfmakeraw(&settings);
    settings.c_cflag |= CLOCAL | CREAD;
    settings.c_cflag &= ~static_cast<tcflag_t>(CRTSCTS | CSTOPB);
    done = cfsetspeed(&settings, speeds().at(baud)) == 0 && tcsetattr(device_.get(), TCSANOW, &settings) == 0;
  }
  if (!done) {
    throw DataError(name_ + ": cannot be set up: " + std::generic_category().message(errno) +
                    "; name a serial port, and a baud rate that it has");
  }
}

void SerialTransport::send(const std::vector<std::uint8_t>& frame) {
  const SteadyTime begin = steady_now();
  std::size_t sent = 0;
  while (sent < frame.size()) {
    const ssize_t count = ::write(device_.get(), frame.data() + sent, frame.size() - sent);
    if (count > 0) {
      sent += static_cast<std::size_t>(count);
      continue;
    }
    if (count < 0 && errno != EAGAIN && errno != EINTR) {
      throw DataError(name_ + ": " + std::generic_category().message(errno) + "; plug the cable in again");
    }
    const double left_ms = kPatience_ms - milliseconds(begin, steady_now());
    if (left_ms <= 0)
      throw DataError(name_ + ": takes no more bytes; raise the baud rate or lower max_rate_hz");
    pollfd writable{device_.get(), POLLOUT, 0};
    ::poll(&writable, 1, static_cast<int>(left_ms) + 1);
  }
}

}  // namespace alight
