#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace alight {

/// printf into a string of at most 400 characters; the compiler checks the arguments against the format.
[[gnu::format(printf, 1, 2)]] inline std::string format_text(const char* format, ...) {
  char buffer[401];
  std::va_list values;
  va_start(values, format);
  std::vsnprintf(buffer, sizeof(buffer), format, values);
  va_end(values);
  return buffer;
}

}  // namespace alight
