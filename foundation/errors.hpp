#pragma once

#include <stdexcept>
#include <string>

namespace alight {

/// A configuration file or command line that cannot be used. Tools end with exit code 2.
/// The message begins with `file:line:` where a line is to blame.
class ConfigError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Something in the outside world is not as it has to be: a missing file, a damaged log, another network's
/// checkpoint. Tools end with exit code 1. The message begins with the file, topic or sample and says what to
/// do.
class DataError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace alight
