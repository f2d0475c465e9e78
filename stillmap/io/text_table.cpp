// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/text_table.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "stillmap/core/error.hpp"
#include "stillmap/core/parse_number.hpp"
#include "stillmap/io/stamp_text.hpp"
#include "stillmap/io/text_file.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMaxTableBytes = std::size_t{64} << 20U;
constexpr std::string_view kBlanks = " \t\r";

constexpr std::size_t kMaxRows = 2'000'000;  // an hour and a half of motion capture at 300 Hz

// The columns of a line, `limit` at most.
std::vector<std::string_view> split(std::string_view line, std::size_t limit) {
  std::vector<std::string_view> columns;
  while (columns.size() < limit) {
    const std::size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string_view::npos) return columns;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(kBlanks), line.size());
    columns.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
  return columns;
}

// A text of a file as a message repeats it: short, and without control characters.
std::string quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : text.substr(0, 40)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > 40 ? "...'" : "'");
}

}  // namespace

TextTable TextTable::read(const std::filesystem::path& path, std::string_view layout) {
  return {path.string(), read_text(path, kMaxTableBytes), layout};
}

TextTable::TextTable(std::string path, std::string text, std::string_view layout)
    : path_(std::move(path)), text_(std::move(text)) {
  const std::size_t expected = split(layout, 100).size();
  std::string_view rest = text_;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    TextRow row{line, split(rest.substr(0, end), expected + 1)};
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (row.columns.empty() || row.columns.front().starts_with('#')) continue;
    if (row.columns.size() != expected) {
      throw Error("{}: {} columns, expected {}: {}",
                  place(row),
                  row.columns.size() > expected ? "more" : std::to_string(row.columns.size()),
                  expected,
                  layout);
    }
    if (rows_.size() == kMaxRows) throw Error("{}: more than {} rows", path_, kMaxRows);
    rows_.push_back(std::move(row));
  }
}

std::string TextTable::place(const TextRow& row) const {
  return fmt::format("{}:{}", path_, row.line);
}

double TextTable::number(const TextRow& row, std::size_t column) const {
  const std::string_view text = row.columns.at(column);
  const std::optional<double> value = parse_number<double>(text);
  if (!value || !std::isfinite(*value)) {
    throw Error(
        "{}: column {} is {}, expected a finite number", place(row), column + 1, quoted(text));
  }
  return *value;
}

Stamp TextTable::stamp(const TextRow& row, std::size_t column) const {
  const std::string_view text = row.columns.at(column);
  if (std::optional<Stamp> stamp = parse_stamp(text)) return *std::move(stamp);
  throw Error("{}: column {} is {}, expected a stamp: a finite number of at most {} characters",
              place(row),
              column + 1,
              quoted(text),
              kMaxStampLength);
}

}  // namespace stillmap
