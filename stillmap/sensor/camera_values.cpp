// SPDX-License-Identifier: Apache-2.0
#include "stillmap/sensor/camera_values.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <yaml-cpp/yaml.h>

#include "stillmap/core/error.hpp"
#include "stillmap/core/joined.hpp"
#include "stillmap/core/parse_number.hpp"
#include "stillmap/io/atomic_file.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMaxCameraFileBytes = std::size_t{1} << 20U;
constexpr std::size_t kMaxCameraValues = 10'000;  // aliases can make many of a short file

double finite_number(const std::string& text, std::string_view key, const std::string& place) {
  const std::optional<double> number = parse_number<double>(text);
  if (!number || !std::isfinite(*number)) {
    throw Error("{}: {} is '{}', expected a finite number", place, key, text);
  }
  return *number;
}

/// Collects the values of nested maps and lists.
class ValueCollector {
 public:
  explicit ValueCollector(std::string file) : file_(std::move(file)) {}

  void add_map(const YAML::Node& map, const std::string& prefix) {
    for (const auto& entry : map) {
      const int line = entry.first.Mark().line + 1;
      if (!entry.first.IsScalar()) {
        throw Error("{}:{}: expected one value for each key, such as 'fx: 535.4'", file_, line);
      }
      const std::string key = prefix + entry.first.Scalar();
      if (!seen_.insert(key).second) throw Error("{}:{}: {} is given twice", file_, line, key);
      if (entry.second.IsMap()) {
        add_map(entry.second, key + '.');
        continue;
      }
      count();
      CameraValue value{key, {}, entry.second.IsSequence(), line};
      add_values(entry.second, value.values);
      values_.push_back(std::move(value));
    }
  }

  [[nodiscard]] std::vector<CameraValue> take() { return std::move(values_); }

 private:
  // Maps in lists are no values of a camera.
  void add_values(const YAML::Node& node, std::vector<std::string>& values) {
    if (node.IsScalar()) {
      count();
      values.push_back(node.Scalar());
    }
    if (!node.IsSequence()) return;
    for (const YAML::Node& element : node) add_values(element, values);
  }

  void count() {
    if (++count_ > kMaxCameraValues) {
      throw Error("{}: more than {} values, expected a camera file", file_, kMaxCameraValues);
    }
  }

  std::string file_;
  std::set<std::string> seen_;
  std::vector<CameraValue> values_;
  std::size_t count_ = 0;
};

// OpenCV's head is no YAML, and tabs, which JSON files have, are no indentation in YAML.
std::string as_yaml(std::string text) {
  if (text.starts_with("%YAML:")) text.front() = '#';
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && text[first] == '{') std::ranges::replace(text, '\t', ' ');
  return text;
}

}  // namespace

CameraValues CameraValues::read(const std::filesystem::path& path) {
  return parse(read_file(path, kMaxCameraFileBytes), path.string());
}

CameraValues CameraValues::parse(std::string text, const std::string& name) {
  CameraValues values;
  values.file_ = name;
  try {
    const YAML::Node root = YAML::Load(as_yaml(std::move(text)));
    if (!root.IsMap()) {
      throw Error("{}: not a camera, expected lines such as 'fx: 535.4'", name);
    }
    ValueCollector collector(name);
    collector.add_map(root, "");
    values.values_ = collector.take();
  } catch (const YAML::Exception& exception) {
    throw Error("{}:{}: not YAML: {}", name, exception.mark.line + 1, exception.msg);
  }
  return values;
}

const CameraValue* CameraValues::find(std::string_view key) const {
  const auto found = std::ranges::find(values_, key, &CameraValue::key);
  return found == values_.end() ? nullptr : &*found;
}

bool CameraValues::has_prefix(std::string_view prefix) const {
  return std::ranges::any_of(
      values_, [&](const CameraValue& value) { return value.key.starts_with(prefix); });
}

std::string CameraValues::place(std::string_view key) const {
  const CameraValue* const value = find(key);
  return value == nullptr ? file_ : fmt::format("{}:{}", file_, value->line);
}

void CameraValues::require(std::span<const std::string> keys, std::string_view advice) const {
  std::vector<std::string> missing;
  for (const std::string& key : keys) {
    if (!has(key)) missing.push_back(key);
  }
  if (!missing.empty()) throw Error("{}: missing {}{}", file_, joined(missing, ", "), advice);
}

const std::string& CameraValues::text(std::string_view key) const {
  const CameraValue* const value = find(key);
  if (value == nullptr) throw Error("{}: missing {}", file_, key);
  if (value->list || value->values.size() != 1) {
    throw Error("{}: expected one value for each key, such as 'fx: 535.4'", place(key));
  }
  return value->values.front();
}

double CameraValues::number(std::string_view key) const {
  return finite_number(text(key), key, place(key));
}

int CameraValues::whole(std::string_view key) const {
  const std::string& value = text(key);
  const std::optional<int> number = parse_number<int>(value);
  if (!number) throw Error("{}: {} is '{}', expected a whole number", place(key), key, value);
  return *number;
}

std::vector<double> CameraValues::numbers(std::string_view key) const {
  const CameraValue* const value = find(key);
  if (value == nullptr) throw Error("{}: missing {}", file_, key);
  if (!value->list) throw Error("{}: {}: expected a list of numbers", place(key), key);
  std::vector<double> numbers;
  for (const std::string& text : value->values) {
    numbers.push_back(finite_number(text, key, place(key)));
  }
  return numbers;
}

}  // namespace stillmap
