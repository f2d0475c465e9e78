// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "stillmap/core/error.hpp"

namespace stillmap {

template <class T>
concept Number = std::is_arithmetic_v<T> && !std::same_as<T, bool>;

namespace bytes_detail {

/// Converts consecutive numbers between the byte order of this machine and little endian.
template <Number T>
void swap_if_big_endian(char* bytes, std::size_t size) {
  if constexpr (std::endian::native == std::endian::big) {
    for (std::size_t i = 0; i < size; i += sizeof(T)) {
      for (std::size_t k = 0; k < sizeof(T) / 2; ++k) {
        std::swap(bytes[i + k], bytes[i + sizeof(T) - 1 - k]);
      }
    }
  }
}

}  // namespace bytes_detail

/// Writes numbers and texts as bytes, little endian, without gaps.
class ByteWriter {
 public:
  template <Number T>
  void number(T value) {
    append<T>(&value, sizeof(T));
  }
  void flag(bool value) { number<std::uint8_t>(value ? 1 : 0); }
  /// Writes the size of the text in 32 bits, and its bytes.
  void text(std::string_view value) {
    count(value.size());
    bytes_.append(value);
  }
  void count(std::size_t value) {
    STILLMAP_CHECK(value <= std::numeric_limits<std::uint32_t>::max());
    number(static_cast<std::uint32_t>(value));
  }
  /// Writes the `T`s of each element, but not the number of elements.
  template <Number T, class Element>
  void array(const std::vector<Element>& values) {
    static_assert(sizeof(Element) % sizeof(T) == 0);
    append<T>(values.data(), values.size() * sizeof(Element));
  }
  /// Writes the three rows of [R t].
  void pose(const Eigen::Isometry3d& T) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) number(T(row, column));
    }
  }
  void vector(const Eigen::Vector3d& v) {
    for (int i = 0; i < 3; ++i) number(v[i]);
  }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  template <Number T>
  void append(const void* values, std::size_t size) {
    if (size == 0) return;
    const std::size_t begin = bytes_.size();
    bytes_.append(static_cast<const char*>(values), size);
    bytes_detail::swap_if_big_endian<T>(bytes_.data() + begin, size);
  }

  std::string bytes_;
};

/// Reads the bytes of a ByteWriter. The bytes need not be trusted: each function throws Error when
/// they do not hold the value asked for, and before it allocates more than they can hold.
class ByteReader {
 public:
  /// `place` names the bytes in messages.
  ByteReader(std::string bytes, std::string place)
      : bytes_(std::move(bytes)), place_(std::move(place)) {}

  template <Number T>
  [[nodiscard]] T number() {
    T value{};
    take<T>(&value, sizeof(T));
    return value;
  }
  [[nodiscard]] bool flag() {
    const auto value = number<std::uint8_t>();
    if (value > 1) throw Error("{}: invalid flag", place_);
    return value == 1;
  }
  [[nodiscard]] std::string text() {
    const std::size_t size = count(1);
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }
  /// Reads the number of following items, of at least `least_size` bytes each.
  [[nodiscard]] std::size_t count(std::size_t least_size) {
    const std::size_t value = number<std::uint32_t>();
    if (value > left() / least_size) fail_short();
    return value;
  }
  template <Number T, class Element>
  [[nodiscard]] std::vector<Element> array(std::size_t size) {
    static_assert(sizeof(Element) % sizeof(T) == 0);
    if (size > left() / sizeof(Element)) fail_short();
    std::vector<Element> values(size);
    take<T>(values.data(), size * sizeof(Element));
    return values;
  }
  [[nodiscard]] Eigen::Isometry3d pose() {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) T(row, column) = number<double>();
    }
    return T;
  }
  [[nodiscard]] Eigen::Vector3d vector() {
    Eigen::Vector3d v;
    for (int i = 0; i < 3; ++i) v[i] = number<double>();
    return v;
  }
  /// Throws Error when bytes are left.
  void finish() const {
    if (left() > 0) throw Error("{}: {} bytes too many", place_, left());
  }

  [[nodiscard]] bool at_end() const { return left() == 0; }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  [[nodiscard]] const std::string& place() const { return place_; }

 private:
  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  [[noreturn]] void fail_short() const {
    throw Error("{}: shorter than what it says to hold", place_);
  }
  template <Number T>
  void take(void* values, std::size_t size) {
    if (size > left()) fail_short();
    if (size == 0) return;
    std::memcpy(values, bytes_.data() + at_, size);
    bytes_detail::swap_if_big_endian<T>(static_cast<char*>(values), size);
    at_ += size;
  }

  std::string bytes_;
  std::string place_;
  std::size_t at_ = 0;
};

}  // namespace stillmap
