// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/ply_header.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kMaxHeaderBytes = 65536;

std::optional<PlyType> type_of(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames = {
      {{"char", PlyType::kInt8},
       {"int8", PlyType::kInt8},
       {"uchar", PlyType::kUint8},
       {"uint8", PlyType::kUint8},
       {"short", PlyType::kInt16},
       {"int16", PlyType::kInt16},
       {"ushort", PlyType::kUint16},
       {"uint16", PlyType::kUint16},
       {"int", PlyType::kInt32},
       {"int32", PlyType::kInt32},
       {"uint", PlyType::kUint32},
       {"uint32", PlyType::kUint32},
       {"float", PlyType::kFloat},
       {"float32", PlyType::kFloat},
       {"double", PlyType::kDouble},
       {"float64", PlyType::kDouble}}};
  for (const auto& [known, type] : kNames) {
    if (known == name) return type;
  }
  return std::nullopt;
}

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
  bool has_list = false;

  [[nodiscard]] std::size_t bytes_each() const {
    std::size_t sum = 0;
    for (const PlyProperty& property : properties) sum += byte_size(property.type);
    return sum;
  }
};

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(" \t\r"), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& name)
      : bytes_(bytes.substr(0, kMaxHeaderBytes)), name_(name) {}

  [[nodiscard]] PlyHeader run() {
    if (next_line() != std::vector<std::string_view>{"ply"}) throw Error("{}: not a PLY", name_);
    while (true) {
      const std::vector<std::string_view> words = next_line();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format" && words.size() == 3) {
        set_format(words[1]);
      } else if (words[0] == "element" && words.size() == 3) {
        add_element(words);
      } else if (words[0] == "property" && words.size() >= 3) {
        add_property(words);
      } else {
        throw Error("{}: not a line of a PLY header", place());
      }
    }
    if (!format_known_) throw Error("{}: the PLY header names no format", name_);
    return finish();
  }

 private:
  [[nodiscard]] std::string place() const { return fmt::format("{}:{}", name_, line_); }

  [[nodiscard]] std::vector<std::string_view> next_line() {
    const std::size_t end = bytes_.find('\n', position_);
    if (end == std::string_view::npos) throw Error("{}: no end of a PLY header", name_);
    const std::string_view line = bytes_.substr(position_, end - position_);
    position_ = end + 1;
    ++line_;
    return words_of(line);
  }

  void set_format(std::string_view format) {
    if (format != "ascii" && format != "binary_little_endian") {
      throw Error("{}: unknown PLY format, expected binary_little_endian or ascii", place());
    }
    header_.binary = format != "ascii";
    format_known_ = true;
  }

  void add_element(const std::vector<std::string_view>& words) {
    Element element;
    element.name = words[1];
    const char* end = words[2].data() + words[2].size();
    const auto [parsed, status] = std::from_chars(words[2].data(), end, element.count);
    if (status != std::errc() || parsed != end) {
      throw Error("{}: the count is not a whole number", place());
    }
    elements_.push_back(std::move(element));
  }

  void add_property(const std::vector<std::string_view>& words) {
    if (elements_.empty()) throw Error("{}: a property of no element", place());
    Element& element = elements_.back();
    if (words[1] == "list") {
      element.has_list = true;
      return;
    }
    const std::optional<PlyType> type = type_of(words[1]);
    if (!type) throw Error("{}: unknown type of a property", place());
    element.properties.push_back({std::string(words[2]), *type});
  }

  [[nodiscard]] PlyHeader finish() {
    header_.header_bytes = position_;
    header_.header_lines = line_;
    constexpr std::size_t kMost = std::numeric_limits<std::size_t>::max();
    for (const Element& element : elements_) {
      const bool wanted = element.name == "vertex";
      if (element.has_list) {
        throw Error("{}: element {} has a list, expected scalars up to the vertices",
                    name_,
                    wanted ? "vertex" : "before the vertices");
      }
      if (wanted) {
        header_.vertices = element.count;
        header_.properties = element.properties;
        return std::move(header_);
      }
      const std::size_t each = std::max<std::size_t>(element.bytes_each(), 1);
      if (element.count > (kMost / 2 - header_.vertex_offset) / each) {
        throw Error("{}: a count that no file can hold", name_);
      }
      header_.vertex_offset += element.count * element.bytes_each();
      header_.vertex_line += element.count;
    }
    throw Error("{}: the PLY has no element 'vertex'", name_);
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t position_ = 0;
  std::size_t line_ = 0;
  bool format_known_ = false;
  std::vector<Element> elements_;
  PlyHeader header_;
};

}  // namespace

std::size_t byte_size(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat:
      return 4;
    case PlyType::kDouble:
      return 8;
  }
  return 0;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& name) {
  return HeaderParser(bytes, name).run();
}

}  // namespace stillmap
