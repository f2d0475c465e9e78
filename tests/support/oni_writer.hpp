// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "stillmap/core/append_bytes.hpp"

namespace stillmap {

/// Writes a recording of OpenNI, with the records that its library writes. The first stream is
/// number 1.
class OniWriter {
 public:
  enum Kind : std::uint32_t { kDepth = 2, kColor = 3 };

  void add_stream(std::uint32_t node, Kind kind, std::string_view codec, cv::Size size) {
    std::string fields = text(kind == kDepth ? "Depth" : "Image");
    append_bytes(fields, static_cast<std::uint32_t>(kind));
    fields += codec;
    append_bytes(fields, std::uint32_t{0});  // frames and first and last stamp: not read
    for (int i = 0; i < 3; ++i) append_bytes(fields, std::uint64_t{0});
    record(13, node, fields);
    std::string mode;
    append_bytes(mode, static_cast<std::uint32_t>(size.width));
    append_bytes(mode, static_cast<std::uint32_t>(size.height));
    append_bytes(mode, std::uint32_t{30});
    general(node, "xnMapOutputMode", mode);
  }
  void field_of_view(std::uint32_t node, double across_rad, double down_rad) {
    std::string angles;
    append_bytes(angles, across_rad);
    append_bytes(angles, down_rad);
    general(node, "xnFOV", angles);
  }
  void general(std::uint32_t node, std::string_view name, std::string_view value) {
    std::string fields = text(name);
    append_bytes(fields, static_cast<std::uint32_t>(value.size()));
    fields.append(value);
    record(6, node, fields);
  }
  void integer(std::uint32_t node, std::string_view name, std::uint64_t value) {
    std::string fields = text(name);
    append_bytes(fields, std::uint32_t{8});
    append_bytes(fields, value);
    record(3, node, fields);
  }
  void image(std::uint32_t node, std::uint64_t stamp_us, std::string_view payload) {
    std::string fields;
    append_bytes(fields, stamp_us);
    append_bytes(fields, ++images_);
    record(10, node, fields, payload);
  }
  void end() { record(11, 0, ""); }

  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  static std::string file_head() {
    std::string head = "NI10";
    for (const std::uint32_t number : {0x00010001U, 0U, 0U, 0U, 0U}) append_bytes(head, number);
    return head;
  }
  static std::string text(std::string_view text) {
    std::string fields;
    append_bytes(fields, static_cast<std::uint32_t>(text.size() + 1));
    fields.append(text);
    fields.push_back('\0');
    return fields;
  }
  void record(std::uint32_t type,
              std::uint32_t node,
              std::string_view fields,
              std::string_view payload = {}) {
    for (const std::uint32_t number : {std::uint32_t{0x0052494E},
                                       type,
                                       node,
                                       static_cast<std::uint32_t>(28 + fields.size()),
                                       static_cast<std::uint32_t>(payload.size()),
                                       std::uint32_t{0},
                                       std::uint32_t{0}}) {
      append_bytes(bytes_, number);
    }
    bytes_ += fields;
    bytes_ += payload;
  }

  std::string bytes_ = file_head();
  std::uint32_t images_ = 0;
};

/// Depth as differences to the pixel before ("16zP"), or to its position in a table ("16zT").
inline std::string encode_oni_depth(const cv::Mat1w& units, bool with_table) {
  std::vector<std::uint16_t> values(units.begin(), units.end()), table = values;
  std::ranges::sort(table);
  table.erase(std::unique(table.begin(), table.end()), table.end());
  std::string bytes;
  const auto put_word = [&](std::uint16_t word) { append_bytes(bytes, word); };
  if (with_table) {
    put_word(static_cast<std::uint16_t>(table.size()));
    for (const std::uint16_t value : table) put_word(value);
    for (std::uint16_t& value : values) {
      value = static_cast<std::uint16_t>(std::ranges::lower_bound(table, value) - table.begin());
    }
  }
  put_word(values[0]);
  const auto step = [&](std::size_t i) {
    return i < values.size() ? values[i] - values[i - 1] : 99;
  };
  const auto put_long = [&](std::size_t i) {
    if (step(i) >= -63 && step(i) <= 64) {
      bytes += static_cast<char>(192 - step(i));
    } else {
      bytes += static_cast<char>(values[i] >> 8);
      bytes += static_cast<char>(values[i] & 0xFF);
    }
  };
  const auto is_small = [](int difference) { return difference >= -6 && difference <= 6; };
  for (std::size_t i = 1; i < values.size();) {
    std::size_t same = 0;
    while (same < 28 && step(i + same) == 0) ++same;
    if (same >= 2) {
      bytes += static_cast<char>(0xE0 + same / 2);
      i += same / 2 * 2;
    } else if (is_small(step(i)) && is_small(step(i + 1)) && (i % 7 != 0 || step(i + 1) != 0)) {
      bytes += static_cast<char>((6 - step(i)) * 16 + 6 - step(i + 1));
      i += 2;
    } else if (is_small(step(i)) && (i + 1 == values.size() || step(i + 1) == 0)) {
      bytes += static_cast<char>((6 - step(i++)) * 16 + 0xD);
    } else if (is_small(step(i))) {
      bytes += static_cast<char>((6 - step(i)) * 16 + 0xF);
      put_long(i + 1);
      i += 2;
    } else {
      bytes += '\xFF';
      put_long(i++);
    }
  }
  return bytes;
}

}  // namespace stillmap
