// SPDX-License-Identifier: Apache-2.0
#include "tooling/browser/message.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kAlignment = 4;

std::size_t aligned(std::size_t size) {
  return (size + kAlignment - 1) / kAlignment * kAlignment;
}

}  // namespace

void Message::add(std::string_view key, std::string_view json) {
  if (!head_.empty()) head_ += ',';
  head_ += '"';
  head_ += key;
  head_ += "\":";
  head_ += json;
}

void Message::pad() {
  body_.resize(aligned(body_.size()), 0);
}

std::size_t Message::attach(std::span<const std::uint8_t> bytes) {
  pad();
  const std::size_t offset = body_.size();
  body_.insert(body_.end(), bytes.begin(), bytes.end());
  return offset;
}

std::size_t Message::attach(std::span<const std::uint16_t> numbers) {
  pad();
  const std::size_t offset = body_.size();
  body_.reserve(offset + 2 * numbers.size());
  for (const std::uint16_t number : numbers) {
    body_.push_back(static_cast<std::uint8_t>(number & 0xffU));
    body_.push_back(static_cast<std::uint8_t>(number >> 8U));
  }
  return offset;
}

std::string Message::bytes() const {
  std::string head = '{' + head_ + '}';
  head.resize(aligned(head.size()), ' ');
  std::string bytes;
  bytes.reserve(kAlignment + head.size() + body_.size());
  for (unsigned shift = 0; shift < 32; shift += 8) {
    bytes += static_cast<char>((head.size() >> shift) & 0xffU);
  }
  bytes += head;
  bytes.append(body_.begin(), body_.end());
  return bytes;
}

}  // namespace stillmap
