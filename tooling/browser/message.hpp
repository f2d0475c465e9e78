// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stillmap {

/// A message to a page, as docs/view.md describes it: a head in JSON, and bytes that the head
/// refers to.
class Message {
 public:
  /// Adds `"key":json` to the head.
  void add(std::string_view key, std::string_view json);
  /// Adds bytes to the body; returns their offset in it, a multiple of 4.
  std::size_t attach(std::span<const std::uint8_t> bytes);
  /// Adds numbers of 16 bits, little endian.
  std::size_t attach(std::span<const std::uint16_t> numbers);

  [[nodiscard]] bool empty() const { return head_.empty() && body_.empty(); }
  [[nodiscard]] std::size_t body_size() const { return body_.size(); }
  /// The length of the head in bytes (32 bits, little endian), the head, padded with spaces so that
  /// the body begins at a multiple of 4, and the body.
  [[nodiscard]] std::string bytes() const;

 private:
  void pad();

  std::string head_;  // without its braces
  std::vector<std::uint8_t> body_;
};

}  // namespace stillmap
