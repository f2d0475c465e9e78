// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/plain_png.hpp"

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <libdeflate.h>

#include "stillmap/io/inflate.hpp"

namespace stillmap {
namespace {

constexpr std::size_t kSignatureBytes = 8;

struct Chunk {
  std::string_view type;
  std::string_view data;
};

std::uint32_t big_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (const char c : bytes.substr(0, 4)) value = value << 8U | static_cast<unsigned char>(c);
  return value;
}

/// Takes the next chunk off the input. Nothing when it is truncated or its checksum is wrong.
std::optional<Chunk> next_chunk(std::string_view& rest) {
  constexpr std::size_t kAround = 12;  // length, type and checksum
  if (rest.size() < kAround) return std::nullopt;
  const std::size_t size = big_endian(rest);
  if (size > rest.size() - kAround) return std::nullopt;
  const std::string_view checked = rest.substr(4, 4 + size);
  if (libdeflate_crc32(0, checked.data(), checked.size()) != big_endian(rest.substr(8 + size)))
    return std::nullopt;
  rest.remove_prefix(kAround + size);
  return Chunk{checked.substr(0, 4), checked.substr(4)};
}

struct Layout {
  int width = 0, height = 0, mat_type = 0;
  std::size_t pixel_bytes = 0;
  [[nodiscard]] std::size_t row_bytes() const {
    return static_cast<std::size_t>(width) * pixel_bytes;
  }
};

std::optional<Layout> read_header(const Chunk& chunk, PngKind kind) {
  if (chunk.type != "IHDR" || chunk.data.size() != 13) return std::nullopt;
  const std::uint32_t width = big_endian(chunk.data), height = big_endian(chunk.data.substr(4));
  constexpr std::uint32_t kMax = kMaxImageSidePx;
  if (width == 0 || height == 0 || width > kMax || height > kMax) return std::nullopt;
  using namespace std::string_view_literals;  // bits, colour, then compression, filter, interlace
  const std::string_view wanted = kind == PngKind::kRgb8    ? "\x08\x02\0\0\0"sv
                                  : kind == PngKind::kGray8 ? "\x08\0\0\0\0"sv
                                                            : "\x10\0\0\0\0"sv;
  if (chunk.data.substr(8) != wanted) return std::nullopt;
  Layout layout{static_cast<int>(width), static_cast<int>(height), CV_8UC3, 3};
  if (kind == PngKind::kGray8) layout.mat_type = CV_8UC1, layout.pixel_bytes = 1;
  if (kind == PngKind::kGray16) layout.mat_type = CV_16UC1, layout.pixel_bytes = 2;
  return layout;
}

/// The data of all IDAT chunks, which must be consecutive. Nothing unless the file ends correctly.
std::optional<std::string> collect_data(std::string_view rest) {
  std::string data;
  data.reserve(rest.size());
  bool begun = false, ended = false;
  for (;;) {
    const std::optional<Chunk> chunk = next_chunk(rest);
    if (!chunk) return std::nullopt;
    if (chunk->type == "IEND") break;
    if (chunk->type == "IDAT") {
      if (ended) return std::nullopt;
      begun = true;
      data += chunk->data;
      continue;
    }
    ended = begun;
    const bool ancillary = (static_cast<unsigned char>(chunk->type[0]) & 0x20U) != 0;
    if (!ancillary && chunk->type != "PLTE") return std::nullopt;
  }
  return data;
}

std::uint8_t paeth(int left, int above, int corner) {
  const int by_left = std::abs(above - corner), by_above = std::abs(left - corner);
  const int by_corner = std::abs(left + above - 2 * corner);
  const int nearer = by_above <= by_corner ? above : corner;
  return static_cast<std::uint8_t>(by_left <= by_above && by_left <= by_corner ? left : nearer);
}

/// Adds `predict(left, above, corner)` to each byte of a row; `above` is the row before.
template <std::size_t kPixel, class Predict>
void add_prediction(std::span<std::uint8_t> row, const std::uint8_t* above, Predict predict) {
  std::array<std::uint8_t, kPixel> left{}, corner{};  // small enough for registers
  for (std::size_t i = 0; i < row.size(); i += kPixel) {
    for (std::size_t k = 0; k < kPixel; ++k) {
      const std::uint8_t up = above[i + k];
      left[k] = static_cast<std::uint8_t>(row[i + k] + predict(left[k], up, corner[k]));
      row[i + k] = left[k];
      corner[k] = up;
    }
  }
}

/// Undoes the filter of a row (PNG specification, section 9). False for an unknown filter.
template <std::size_t kPixel>
bool unfilter(std::uint8_t filter, std::span<std::uint8_t> row, const std::uint8_t* above) {
  switch (filter) {
    case 0:
      return true;
    case 1:
      add_prediction<kPixel>(row, above, [](int left, int, int) { return left; });
      return true;
    case 2:
      for (std::size_t i = 0; i < row.size(); ++i) {
        row[i] = static_cast<std::uint8_t>(row[i] + above[i]);
      }
      return true;
    case 3:
      add_prediction<kPixel>(row, above, [](int left, int up, int) { return (left + up) / 2; });
      return true;
    case 4:
      add_prediction<kPixel>(row, above, paeth);
      return true;
    default:
      return false;
  }
}

void copy_row(const std::uint8_t* source, const Layout& layout, std::uint8_t* target) {
  if (layout.mat_type != CV_16UC1) {
    std::memcpy(target, source, layout.row_bytes());
    return;
  }
  auto* samples = reinterpret_cast<std::uint16_t*>(target);
  for (int x = 0; x < layout.width; ++x) {
    samples[x] = static_cast<std::uint16_t>(source[2 * x] << 8 | source[2 * x + 1]);
  }
}

/// Decodes the rows of a file, each of which follows the number of its filter.
std::optional<cv::Mat> unfiltered(std::vector<std::uint8_t> rows, const Layout& layout) {
  cv::Mat image(layout.height, layout.width, layout.mat_type);
  const std::size_t size = layout.row_bytes();
  const std::vector<std::uint8_t> zeros(size, 0);
  const std::uint8_t* above = zeros.data();
  for (int v = 0; v < layout.height; ++v) {
    std::uint8_t* at = &rows[static_cast<std::size_t>(v) * (size + 1)];
    const std::span row(at + 1, size);
    const bool known = layout.pixel_bytes == 1   ? unfilter<1>(*at, row, above)
                       : layout.pixel_bytes == 2 ? unfilter<2>(*at, row, above)
                                                 : unfilter<3>(*at, row, above);
    if (!known) return std::nullopt;
    copy_row(row.data(), layout, image.ptr(v));
    above = row.data();
  }
  return image;
}

}  // namespace

std::optional<cv::Mat> decode_plain_png(std::string_view bytes, PngKind kind) {
  if (!is_png(bytes)) return std::nullopt;
  std::string_view rest = bytes.substr(kSignatureBytes);
  const std::optional<Chunk> header = next_chunk(rest);
  if (!header) return std::nullopt;
  const std::optional<Layout> layout = read_header(*header, kind);
  if (!layout) return std::nullopt;
  const std::optional<std::string> data = collect_data(rest);
  if (!data) return std::nullopt;
  const std::size_t size = static_cast<std::size_t>(layout->height) * (layout->row_bytes() + 1);
  std::optional<std::vector<std::uint8_t>> rows = inflate_whole(*data, size);
  if (!rows) return std::nullopt;
  return unfiltered(std::move(*rows), *layout);
}

}  // namespace stillmap
