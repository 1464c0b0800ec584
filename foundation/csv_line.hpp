#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "foundation/errors.hpp"

namespace alight {

/// The cells of one line of a CSV file, left to right; complains with `file:line` and the column's name.
class CsvLine {
 public:
  CsvLine(std::string text, std::string place) : text_(std::move(text)), place_(std::move(place)) {}

  template <class Integer>
  Integer integer(const char* column) {
    const std::string_view cell = next(column);
    Integer value{};
    const auto result = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (result.ec != std::errc() || result.ptr != cell.data() + cell.size()) fail(column, cell, "an integer");
    return value;
  }

  /// A finite number.
  double number(const char* column) {
    const double value = number_or_nan(column);
    if (!std::isfinite(value)) fail(std::string(column) + ": expected a finite number");
    return value;
  }

  double number_or_nan(const char* column) {
    const std::string_view cell = next(column);
    if (cell == "nan") return std::numeric_limits<double>::quiet_NaN();
    double value = 0;
    const auto result = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    if (result.ec != std::errc() || result.ptr != cell.data() + cell.size()) fail(column, cell, "a number");
    return value;
  }

  void expect_end() const {
    if (at_ <= text_.size()) fail("has more columns than expected");
  }

  [[noreturn]] void fail(const std::string& what) const { throw DataError(place_ + ": " + what); }

 private:
  [[noreturn]] void fail(const char* column, std::string_view cell, const char* expected) const {
    fail(std::string(column) + ": expected " + expected + ", got \"" + std::string(cell) + "\"");
  }

  std::string_view next(const char* column) {
    if (at_ > text_.size()) fail(std::string(column) + ": the line ends early");
    const std::size_t comma = std::min(text_.find(',', at_), text_.size());
    const std::string_view cell = std::string_view(text_).substr(at_, comma - at_);
    at_ = comma + 1;
    return cell;
  }

  std::string text_;
  std::string place_;
  std::size_t at_ = 0;
};

}  // namespace alight
