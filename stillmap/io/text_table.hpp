// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// One line of data in a text table: its number in the file, from 1, and its columns.
struct TextRow {
  std::size_t line = 0;
  std::vector<std::string_view> columns;  ///< point into the table's text
};

/// A text file of columns apart by blanks, as the TUM benchmark uses them: `#` starts a line of
/// comment, empty lines count for nothing, lines may end as on Windows.
class TextTable {
 public:
  /// Throws Error when the file cannot be read, has more than 64 MiB or two million rows, or when a
  /// row has not as many columns as `layout` names (as in "stamp file").
  [[nodiscard]] static TextTable read(const std::filesystem::path& path, std::string_view layout);
  TextTable(const TextTable&) = delete;
  TextTable& operator=(const TextTable&) = delete;

  [[nodiscard]] const std::vector<TextRow>& rows() const { return rows_; }

  /// "file:line", for messages.
  [[nodiscard]] std::string place(const TextRow& row) const;

  /// A finite number. Throws Error for anything else.
  [[nodiscard]] double number(const TextRow& row, std::size_t column) const;

  /// The number with its text. Throws Error for anything but a finite number.
  [[nodiscard]] Stamp stamp(const TextRow& row, std::size_t column) const;

 private:
  TextTable(std::string path, std::string text, std::string_view layout);

  std::string path_;
  std::string text_;
  std::vector<TextRow> rows_;
};

}  // namespace stillmap
