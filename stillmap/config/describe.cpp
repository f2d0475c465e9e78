// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <iterator>

#include <fmt/core.h>

#include "stillmap/config/config_io.hpp"
#include "stillmap/config/field_text.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kLineWidth = 100;
constexpr std::size_t kIndent = 4;
constexpr std::size_t kLongValue = 24;  // a longer value gets lines of its own

// The words of a text on indented lines of at most kLineWidth characters. A longer word gets a line
// of its own.
std::string wrapped(std::string_view text) {
  std::string lines, line;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(text.size(), word.size() + 1));
    if (!line.empty() && line.size() + 1 + word.size() > kLineWidth) {
      lines += line + '\n';
      line.clear();
    }
    line += std::string(line.empty() ? kIndent : 1, ' ');
    line += word;
  }
  return line.empty() ? lines : lines + line + '\n';
}

std::string value_with_unit(const FieldRef& field) {
  std::string value = format_value(field);
  if (value.empty()) value = "\"\"";
  return field.info.unit.empty() ? value : fmt::format("{} {}", value, field.info.unit);
}

struct Columns {
  std::size_t key = 0, value = 0;
};

Columns columns_of(std::span<const FieldRef> fields) {
  Columns columns{std::string_view("KEY").size(), std::string_view("VALUE").size()};
  for (const FieldRef& field : fields) {
    columns.key = std::max(columns.key, field.key.size());
    const std::size_t size = value_with_unit(field).size();
    if (size <= kLongValue) columns.value = std::max(columns.value, size);
  }
  return columns;
}

std::string table_line(const Columns& columns,
                       std::string_view key,
                       std::string_view value,
                       std::string_view allowed) {
  std::string line =
      fmt::format("{:<{}}  {:<{}}  {}", key, columns.key, value, columns.value, allowed);
  line.erase(line.find_last_not_of(' ') + 1);
  return line + '\n';
}

std::string describe_field(const FieldRef& field, const Columns& columns) {
  const std::string value = value_with_unit(field);
  const std::string allowed = allowed_values(field);
  const bool long_value = value.size() > kLongValue;
  const std::string shown = long_value ? "" : value;
  const std::string line = table_line(columns, field.key, shown, allowed);
  const bool too_long = line.size() > kLineWidth + 1;  // with its line end
  std::string text = too_long ? table_line(columns, field.key, shown, "") : line;
  text += wrapped(field.info.meaning);
  if (long_value) text += wrapped("value: " + value);
  if (too_long) text += wrapped("allowed: " + allowed);
  return text;
}

}  // namespace

std::vector<FieldRef> common_fields(std::span<const FieldRef> fields) {
  std::vector<FieldRef> common;
  std::ranges::copy_if(
      fields, std::back_inserter(common), [](const FieldRef& field) { return field.info.common; });
  return common;
}

std::string describe(std::span<const FieldRef> fields) {
  const Columns columns = columns_of(fields);
  std::string text = table_line(columns, "KEY", "VALUE", "ALLOWED");
  for (const FieldRef& field : fields) text += describe_field(field, columns);
  return text;
}

}  // namespace stillmap
