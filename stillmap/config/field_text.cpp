// SPDX-License-Identifier: Apache-2.0
#include "stillmap/config/field_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <type_traits>

#include <fmt/core.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kShownBytes = 60;

// A whole text as a number. Nothing when it is no number or does not fit the type.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number number{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// A number of the field's type within the field's range. Nothing for any other text. NaN and
// infinity are in no range.
template <class Number>
std::optional<Number> parse_in_range(std::string_view text, const FieldInfo& info) {
  const std::optional<Number> number = parse_number<Number>(text);
  if (!number) return std::nullopt;
  const auto value = static_cast<double>(*number);
  if (!std::isfinite(value) || value < info.min || value > info.max) return std::nullopt;
  return number;
}

struct Bounds {
  std::optional<double> min;
  std::optional<double> max;
};

// The bounds that the field sets, or that an unsigned type implies.
Bounds bounds(const FieldRef& field) {
  Bounds result;
  const bool is_unsigned = std::holds_alternative<std::uint32_t*>(field.value);
  if (field.info.min > std::numeric_limits<double>::lowest()) result.min = field.info.min;
  if (field.info.max < std::numeric_limits<double>::max()) result.max = field.info.max;
  if (is_unsigned && result.min.value_or(-1.0) < 0.0) result.min = 0.0;
  return result;
}

std::string allowed_numbers(const FieldRef& field) {
  const auto [min, max] = bounds(field);
  if (min && max) return fmt::format("{} to {}", *min, *max);
  if (min) return fmt::format("at least {}", *min);
  if (max) return fmt::format("at most {}", *max);
  return "";
}

bool is_choice(const FieldInfo& info, std::string_view text) {
  return info.choices.empty() || std::ranges::find(info.choices, text) != info.choices.end();
}

bool is_one_line(std::string_view text) {
  return text_prefix(text) == text.size() && text.find_first_of("\t\r\n") == std::string_view::npos;
}

template <class Value>
std::optional<Value> parse_value(std::string_view text, Quoting quoting, const FieldInfo& info) {
  if constexpr (std::is_same_v<Value, std::string>) {
    if (!is_one_line(text) || !is_choice(info, text)) return std::nullopt;
    return std::string(text);
  } else {
    if (quoting == Quoting::kQuoted) return std::nullopt;
    if constexpr (std::is_same_v<Value, bool>) {
      if (text == "true") return true;
      if (text == "false") return false;
      return std::nullopt;
    } else {
      return parse_in_range<Value>(text, info);
    }
  }
}

std::size_t utf8_length(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first < 0xE0) return 2;
  if (first >= 0xE0 && first < 0xF0) return 3;
  if (first >= 0xF0 && first < 0xF5) return 4;
  return 0;
}

}  // namespace

std::size_t text_prefix(std::string_view bytes) {
  std::size_t at = 0;
  while (at < bytes.size()) {
    const auto first = static_cast<unsigned char>(bytes[at]);
    if ((first < 0x20 && first != '\t' && first != '\n' && first != '\r') || first == 0x7F) break;
    const std::size_t length = utf8_length(first);
    if (length == 0 || at + length > bytes.size()) break;
    const std::string_view rest = bytes.substr(at + 1, length - 1);
    const bool continues = std::ranges::all_of(
        rest, [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; });
    if (!continues) break;
    at += length;
  }
  return at;
}

std::string printable(std::string_view text) {
  std::string shown;
  for (const char c : text.substr(0, kShownBytes)) {
    const auto byte = static_cast<unsigned char>(c);
    shown += byte < 0x20 || byte >= 0x7F ? '?' : c;
  }
  return text.size() > kShownBytes ? shown + "..." : shown;
}

bool is_text(const FieldRef& field) {
  return std::holds_alternative<std::string*>(field.value);
}

std::string format_value(const FieldRef& field) {
  return std::visit([](const auto* value) { return fmt::format("{}", *value); }, field.value);
}

std::string allowed_values(const FieldRef& field) {
  if (is_text(field)) return joined(field.info.choices, ", ");
  if (std::holds_alternative<bool*>(field.value)) return "true, false";
  return allowed_numbers(field);
}

std::string expectation(const FieldRef& field) {
  const std::string allowed = allowed_values(field);
  if (std::holds_alternative<bool*>(field.value)) return "true or false";
  if (is_text(field)) return allowed.empty() ? "a text on one line" : "one of " + allowed;
  const Bounds limits = bounds(field);
  std::string text = std::holds_alternative<double*>(field.value) ? "a number" : "a whole number";
  if (limits.min && limits.max) text += " from";
  if (!allowed.empty()) text += ' ' + allowed;
  if (field.info.unit.empty()) return text;
  text += allowed.empty() ? " in " : " ";
  text += field.info.unit;
  return text;
}

void assign(const FieldRef& field, std::string_view text, Quoting quoting, std::string_view where) {
  std::visit(
      [&](auto* target) {
        using Value = std::remove_pointer_t<decltype(target)>;
        std::optional<Value> value = parse_value<Value>(text, quoting, field.info);
        if (!value) {
          const char* mark = quoting == Quoting::kQuoted ? "\"" : "'";
          throw Error("{}: {}: expected {}, got {}{}{}",
                      where,
                      field.key,
                      expectation(field),
                      mark,
                      printable(text),
                      mark);
        }
        *target = *std::move(value);
      },
      field.value);
}

}  // namespace stillmap
