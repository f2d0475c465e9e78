// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "stillmap/core/trajectory.hpp"

namespace stillmap {

/// One row of a text table: its line number in the file, from 1, and its columns.
struct TextRow {
  std::size_t line = 0;
  std::vector<std::string_view> columns;  ///< they point into the text of the table
};

/// A text file with columns separated by blanks, as in the TUM benchmark. `#` begins a comment
/// line, empty lines are ignored, and lines may end with CR LF. The file is read by read_text().
class TextTable {
 public:
  /// Throws Error when the file cannot be read, has more than 64 MiB or two million rows, or when
  /// the number of columns of a row differs from that of `layout` ("stamp file" has two).
  [[nodiscard]] static TextTable read(const std::filesystem::path& path, std::string_view layout);
  TextTable(const TextTable&) = delete;
  TextTable& operator=(const TextTable&) = delete;

  [[nodiscard]] const std::vector<TextRow>& rows() const { return rows_; }

  /// "file:line", for messages.
  [[nodiscard]] std::string place(const TextRow& row) const;

  /// A finite number. Throws Error for any other text.
  [[nodiscard]] double number(const TextRow& row, std::size_t column) const;

  /// The stamp that parse_stamp() reads there. Throws Error for any other text.
  [[nodiscard]] Stamp stamp(const TextRow& row, std::size_t column) const;

 private:
  TextTable(std::string path, std::string text, std::string_view layout);

  std::string path_;
  std::string text_;
  std::vector<TextRow> rows_;
};

}  // namespace stillmap
