// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstring>
#include <string>
#include <type_traits>

namespace stillmap {

static_assert(std::endian::native == std::endian::little,
              "values are copied as they are in memory");

/// Appends the bytes of a number, little endian.
template <class T>
void append_bytes(std::string& bytes, T value) {
  static_assert(std::is_arithmetic_v<T>);
  std::array<char, sizeof(T)> raw;
  std::memcpy(raw.data(), &value, raw.size());
  bytes.append(raw.data(), raw.size());
}

}  // namespace stillmap
