// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stillmap {

/// One value of a camera file: a number or word, or the numbers of a list.
struct CameraValue {
  std::string key;                  ///< of nested maps, joined by dots: "depth.fx"
  std::vector<std::string> values;  ///< of lists of lists, one after the other
  bool list = false;                ///< whether the file has a list
  int line = 0;                     ///< in the file, from 1
};

/// The values of a camera file by key, from YAML or JSON. OpenCV's head `%YAML:1.0` is understood.
/// Every function throws Error in one line with file, line and key where it is not what it asks.
class CameraValues {
 public:
  /// Reads a file. Throws Error for a file that is no map, that gives a key twice, or that has more
  /// than ten thousand values.
  [[nodiscard]] static CameraValues read(const std::filesystem::path& path);
  /// The values in a text; messages call it `name`.
  [[nodiscard]] static CameraValues parse(std::string text, const std::string& name);

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::vector<CameraValue>& all() const { return values_; }
  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  /// Whether any key begins so.
  [[nodiscard]] bool has_prefix(std::string_view prefix) const;

  /// "file:line" of a key, for messages; the file where the key is missing.
  [[nodiscard]] std::string place(std::string_view key) const;

  /// Throws Error that lists the keys that are missing; `advice` follows.
  void require(std::span<const std::string> keys, std::string_view advice = "") const;

  /// A word, number or any other single value. The key must be there, as for all that follow.
  [[nodiscard]] const std::string& text(std::string_view key) const;
  /// A finite number.
  [[nodiscard]] double number(std::string_view key) const;
  /// A whole number.
  [[nodiscard]] int whole(std::string_view key) const;
  /// A list of finite numbers.
  [[nodiscard]] std::vector<double> numbers(std::string_view key) const;

 private:
  [[nodiscard]] const CameraValue* find(std::string_view key) const;

  std::string file_;
  std::vector<CameraValue> values_;
};

}  // namespace stillmap
