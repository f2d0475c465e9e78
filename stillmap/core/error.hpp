// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include <fmt/core.h>

namespace stillmap {

/// An exception for wrong data from outside (a file, a key, an argument). Its text is one line that
/// names the file or key, says what was expected and what to do. The program prints it and exits
/// with 2. An expected outcome (tracking lost, no match) is a value, never an Error.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  /// The text is that of fmt::format(format, args...).
  template <class... Args>
  explicit Error(fmt::format_string<Args...> format, Args&&... args)
      : std::runtime_error(fmt::format(format, std::forward<Args>(args)...)) {}
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
