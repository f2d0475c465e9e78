// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/core.h>

namespace stillmap {

/// An exception for wrong data from outside (a file, a key, an argument). Its text is one line that
/// names the file or key, says what was expected and what to do. The program prints it and exits
/// with 2. An expected outcome (tracking lost, no match) is a value, never an Error.
class Error : public std::runtime_error {
 public:
  /// The text, in which a blank replaces each control character: messages quote files from outside.
  explicit Error(std::string text) : std::runtime_error(one_line(std::move(text))) {}

  /// The text is that of fmt::format(format, args...).
  template <class... Args>
  explicit Error(fmt::format_string<Args...> format, Args&&... args)
      : Error(fmt::format(format, std::forward<Args>(args)...)) {}

 private:
  static std::string one_line(std::string text) {
    for (char& c : text) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x20 || byte == 0x7F) c = ' ';
    }
    return text;
  }
};

/// An exception for a programming mistake in this library. Thrown by STILLMAP_CHECK; the program
/// exits with 1.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace stillmap

/// Throws InternalError with the expression, file and line when `condition` does not hold.
/// For invariants of this library only; wrong data from outside is an Error.
#define STILLMAP_CHECK(condition)                                                   \
  do {                                                                              \
    if (!(condition))                                                               \
      throw ::stillmap::InternalError(                                              \
          fmt::format("check failed: {} ({}:{})", #condition, __FILE__, __LINE__)); \
  } while (false)
