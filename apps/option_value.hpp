// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "stillmap/core/error.hpp"

namespace stillmap {

/// `read(text)`, where an Error about the text itself ("TEXT: expected ...") says of which option
/// of the command line it is the value.
template <class Read>
auto option_value(const char* option, const std::string& text, const Read& read) {
  try {
    return read(text);
  } catch (const Error& error) {
    if (!std::string_view(error.what()).starts_with(text + ":")) throw;
    throw Error("{} {}", option, error.what());
  }
}

}  // namespace stillmap
