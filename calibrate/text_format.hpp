#pragma once

#include <cstdio>
#include <string>

namespace alight {

/// printf into a string of at most 400 characters.
template <class... Values>
std::string format_text(const char* format, Values... values) {
  char buffer[401];
  std::snprintf(buffer, sizeof(buffer), format, values...);
  return buffer;
}

}  // namespace alight
