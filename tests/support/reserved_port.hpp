#pragma once

namespace alight::test {

/// A TCP port of the loopback device that the kernel gave, for a program that has to be told its port. It stays reserved
/// while the object lives: the kernel gives it to nobody else, but a server that sets SO_REUSEADDR can listen on it.
class ReservedPort {
 public:
  /// @throws std::system_error if there is none
  ReservedPort();
  ~ReservedPort();
  ReservedPort(const ReservedPort&) = delete;
  ReservedPort& operator=(const ReservedPort&) = delete;

  int number() const { return number_; }

 private:
  int socket_;
  int number_ = 0;
};

}  // namespace alight::test
