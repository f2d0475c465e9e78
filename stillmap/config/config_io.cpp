// SPDX-License-Identifier: Apache-2.0
#include "stillmap/config/config_io.hpp"

#include <algorithm>

#include <fmt/core.h>

#include "stillmap/config/field_keys.hpp"
#include "stillmap/config/field_text.hpp"
#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

// Text in double quotes, the only YAML style that can hold any text.
std::string yaml_quoted(std::string_view text) {
  std::string yaml = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      yaml += fmt::format("\\x{:02x}", byte);
    } else {
      if (c == '"' || c == '\\') yaml += '\\';
      yaml += c;
    }
  }
  return yaml + '"';
}

std::vector<std::string_view> split_key(std::string_view key) {
  std::vector<std::string_view> parts;
  for (std::size_t dot = key.find('.'); dot != std::string_view::npos; dot = key.find('.')) {
    parts.push_back(key.substr(0, dot));
    key.remove_prefix(dot + 1);
  }
  parts.push_back(key);
  return parts;
}

struct YamlLine {
  std::string text;
  std::string comment;
};

std::string comment_of(const FieldInfo& info) {
  if (info.unit.empty()) return std::string(info.meaning);
  return fmt::format("{} ({})", info.meaning, info.unit);
}

// One line per field, and one at the beginning of each group.
std::vector<YamlLine> yaml_lines(std::span<const FieldRef> fields) {
  std::vector<YamlLine> lines;
  std::vector<std::string_view> open;  // the groups of the line before
  for (const FieldRef& field : fields) {
    std::vector<std::string_view> groups = split_key(field.key);
    const std::string_view name = groups.back();
    groups.pop_back();
    const auto common = std::ranges::mismatch(groups, open).in1;
    for (auto group = common; group != groups.end(); ++group) {
      const auto depth = static_cast<std::size_t>(group - groups.begin());
      lines.push_back({fmt::format("{}{}:", std::string(2 * depth, ' '), *group), ""});
    }
    const std::string value =
        is_text(field) ? yaml_quoted(format_value(field)) : format_value(field);
    lines.push_back({fmt::format("{}{}: {}", std::string(2 * groups.size(), ' '), name, value),
                     comment_of(field.info)});
    open = std::move(groups);
  }
  return lines;
}

}  // namespace

void set_value(std::span<const FieldRef> fields,
               std::string_view assignment,
               std::string_view where) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    throw Error("{} {}: expected key=value", where, printable(assignment));
  }
  set_value(fields, assignment.substr(0, equals), assignment.substr(equals + 1), where);
}

void set_value(std::span<const FieldRef> fields,
               std::string_view key,
               std::string_view value,
               std::string_view where) {
  const FieldRef* field = find_field(fields, key);
  if (field == nullptr) {
    const FieldRef* member = find_group(fields, key);
    if (member != nullptr) throw_is_group(*member, key, where);
    throw_unknown_key(fields, key, where);
  }
  assign(*field, value, Quoting::kPlain, where);
}

std::string value_text(std::span<const FieldRef> fields, std::string_view key) {
  const FieldRef* field = find_field(fields, key);
  if (field == nullptr) throw_unknown_key(fields, key, "settings");
  return format_value(*field);
}

std::string dump_yaml(std::span<const FieldRef> fields) {
  const std::vector<YamlLine> lines = yaml_lines(fields);
  std::size_t width = 0;
  for (const YamlLine& line : lines) width = std::max(width, line.text.size());
  width = std::min<std::size_t>(width, 40);  // the few longer lines are not aligned
  std::string yaml;
  for (const YamlLine& line : lines) {
    yaml += line.comment.empty() ? line.text + '\n'
                                 : fmt::format("{:<{}}  # {}\n", line.text, width, line.comment);
  }
  return yaml;
}

}  // namespace stillmap
