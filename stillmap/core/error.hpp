// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include <fmt/core.h>

namespace stillmap {

/// What is wrong with data from outside (a file, a key, an argument), in one line that names the
/// file or key, says what was expected and what to do. The command line prints it and exits with 2.
/// An expected outcome (tracking lost, no match) is never an Error but a value.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  template <class... Args>
  explicit Error(fmt::format_string<Args...> format, Args&&... args)
      : std::runtime_error(fmt::format(format, std::forward<Args>(args)...)) {}
};

/// A mistake of our own: thrown by STILLMAP_CHECK, exit code 1.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace stillmap

/// Throws InternalError with the expression and its place when `condition` does not hold.
/// For invariants of our own code only; bad input is an Error.
#define STILLMAP_CHECK(condition)                                                   \
  do {                                                                              \
    if (!(condition))                                                               \
      throw ::stillmap::InternalError(                                              \
          fmt::format("check failed: {} ({}:{})", #condition, __FILE__, __LINE__)); \
  } while (false)
